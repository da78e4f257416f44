#include "core/search/start_distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "core/world/separation.hpp"

namespace rtg::search {
namespace {

constexpr double kPushesBetweenObjects = 2.0;  // approximate
constexpr double kInPlace = 0.4;   // largest distance of an object in place from its place [m]
constexpr double kDetour = 0.4;    // least detour around gates that has them opened [m]
constexpr double kInRange = 0.8;   // the same for the angle beyond those of its starts [rad]
constexpr double kPullCone = 0.5;  // largest angle at the object between robot and pull [rad]
constexpr double kReach = 0.15;    // largest gap over which the robot can pull an object [m]
constexpr double kTouching = 0.8;  // approximate distance of touching bodies / sum of their radii

/// Returns the largest distance between the centres at which the robot can pull `body` [m].
double farthest_pull(const tasks::Task& task, std::size_t body) {
  return task.scene.bodies[0].shape.radius() + task.scene.bodies[body].shape.radius() + kReach;
}

/// Returns whether the robot at pose `robot` touches `body` at pose `object` on the side to which
/// `way` points.
bool can_pull(const tasks::Task& task, const Pose& robot, const Pose& object, std::size_t body,
              const Vector2d& way) {
  const Shape& hand = task.scene.bodies[0].shape;
  const Shape& shape = task.scene.bodies[body].shape;
  const Vector2d arm = robot.position() - object.position();
  if (arm.norm() > farthest_pull(task, body) ||
      arm.dot(way) < turn_of(kPullCone).c * arm.norm() * way.norm())
    return false;
  const double gap = separation(hand, robot, shape, object);
  return gap >= 0.0 && gap <= kReach;
}

/// Estimates the number of pushes until the robot can pull `body` along `way`. Returns 0, 1, or the
/// distance in strides. The last is at least 2, because two pushes reach any distance of up to two
/// strides.
double approach_pushes(const tasks::Task& task, const StateMetric& metric, const Poses& poses,
                       std::size_t body, const Vector2d& way) {
  const Pose& robot = poses[0];
  const Pose& object = poses[body];
  if (can_pull(task, robot, object, body, way)) return 0.0;
  const double apart = (robot.position() - object.position()).norm();
  for (int a = 0; a < action_count(task.push); ++a) {
    const double stride = stride_of(a, task.push);
    if (std::abs(apart - stride) > farthest_pull(task, body)) continue;
    const Vector2d at = robot.position() - stride * direction(a, task.push);
    if (can_pull(task, {at.x(), at.y(), robot.theta}, object, body, way)) return 1.0;
  }
  const double touching =
      kTouching * (task.scene.bodies[0].shape.radius() + task.scene.bodies[body].shape.radius());
  const Vector2d spot = object.position() + touching * way.normalized();
  return std::max(2.0,
                  metric.way(0, poses, robot.position(), spot).length / longest_stride(task.push));
}

/// Returns whether object `o` is in place. With a joint the angle counts, too, because a pin can
/// hold the centre in place at any angle.
bool in_place(const StateMetric& metric, const StateMetric::Object& o, const Poses& poses,
              const Poses& target) {
  return (o.jointed ? metric.distance(o, poses, target)
                    : (poses[o.body].position() - target[o.body].position()).norm()) <= kInPlace;
}

/// Returns the gates that are in the way of an object that is out of place: those whose opening
/// alone makes its way shorter, or all of them if only that does.
std::vector<std::size_t> shut_gates(const StateMetric& metric, const Poses& poses,
                                    const Poses& target) {
  const std::vector<std::size_t> all(metric.gates().begin(), metric.gates().end());
  std::vector<std::size_t> shut;
  for (const auto& o : metric.objects()) {
    const double detour = metric.detour(o, poses, target);
    if (detour <= kDetour || in_place(metric, o, poses, target)) continue;
    const auto frees = [&](const Poses& open) {
      return metric.detour(o, open, target) < detour - kDetour;
    };
    Poses all_open = poses;
    std::vector<std::size_t> alone;
    for (const std::size_t gate : all) {
      all_open = metric.opened(gate, all_open, target);
      if (frees(metric.opened(gate, poses, target))) alone.push_back(gate);
    }
    if (alone.empty() && frees(all_open)) return all;
    shut.insert(shut.end(), alone.begin(), alone.end());
  }
  return shut;
}

/// Estimates the number of pushes until the robot is in its own place, where all objects are.
double pushes_home(const tasks::Task& task, const StateMetric& metric, const Poses& poses,
                   const Poses& target) {
  const double home = metric.way(0, poses, poses[0].position(), target[0].position()).length;
  if (home <= kInPlace) return 0.0;
  for (const double stride : task.push.strides)
    if (std::abs(home - stride) <= kInPlace) return 1.0;
  return std::max(2.0, home / longest_stride(task.push));
}

}  // namespace

double start_distance(const tasks::Task& task, const StateMetric& metric, const Poses& poses,
                      const Poses& target) {
  const double stride = longest_stride(task.push);
  const Vector2d home = target[0].position();
  const auto from_home = [&](const Vector2d& to) {
    return metric.way(0, poses, home, to).length / stride;
  };
  const std::vector<std::size_t> shut = shut_gates(metric, poses, target);
  double sum = 0.0, first = std::numeric_limits<double>::infinity();
  for (const auto& o : metric.objects()) {
    const bool opens = std::ranges::count(shut, o.body) > 0;
    if (!opens && in_place(metric, o, poses, target)) continue;
    const Vector2d from = poses[o.body].position();
    Vector2d to = target[o.body].position();
    const double there = from_home(from);
    sum += kPushesBetweenObjects + there + from_home(to);
    if (opens) {
      const Poses open = metric.opened(o.body, poses, target);
      to = open[o.body].position();
      sum +=
          kPushesBetweenObjects + 2.0 * from_home(to) +
          (metric.distance(o, poses, open) + metric.distance(o, open, target)) / (stride * o.pace);
    } else {
      sum += metric.distance_around(o, poses, target) / (stride * o.pace);
    }
    const Vector2d way = metric.way(o.body, poses, from, to).next - from;
    first = std::min(first, approach_pushes(task, metric, poses, o.body, way) - there);
  }
  return std::isfinite(first) ? sum + first : pushes_home(task, metric, poses, target);
}

bool in_place(const StateMetric& metric, const Poses& poses, const Poses& target) {
  return std::ranges::all_of(metric.objects(),
                             [&](const auto& o) { return in_place(metric, o, poses, target); });
}

bool in_start_region(const tasks::Task& task, const StateMetric& metric, const Poses& poses) {
  if (task.start_ranges.empty()) return in_place(metric, poses, task.start);
  const Poses layout = layout_around(task, poses);
  return std::ranges::all_of(metric.objects(), [&](const auto& o) {
    const tasks::StartRange* range = task.start_range(o.body);
    if (!range) return in_place(metric, o, poses, layout);
    if (excess(range->region, poses[o.body].position()) > kInPlace) return false;
    const double off = poses[o.body].theta - (range->least + range->most) / 2.0;
    const double turn = o.turn > 0.0 ? std::abs(std::remainder(off, o.turn)) : 0.0;
    return turn <= (range->most - range->least) / 2.0 + kInRange;
  });
}

Poses snapped_to_start(const tasks::Task& task, const StateMetric& metric, Poses poses,
                       const Poses& target, const Poses& start) {
  const double from_home = (poses[0].position() - target[0].position()).norm();
  if (from_home <= kInPlace && in_place(metric, poses, target)) poses[0] = start[0];
  const std::vector<std::size_t> group_roots = moving_group_roots(task.scene);
  std::vector<bool> stays(poses.size(), false);  // by group root
  for (const auto& o : metric.objects())
    if (!in_place(metric, o, poses, target)) stays[group_roots[o.body]] = true;
  for (const auto& o : metric.objects())
    if (!stays[group_roots[o.body]]) poses[o.body] = start[o.body];
  return poses;
}

}  // namespace rtg::search

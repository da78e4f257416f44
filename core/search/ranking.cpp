#include "core/search/ranking.hpp"

#include <algorithm>
#include <limits>
#include <unordered_map>

#include "core/world/separation.hpp"

namespace rtg {
namespace {

constexpr double kApproachWeight = 0.12;  // per metre of layout distance
constexpr double kPullCone = 0.5;         // [rad]
constexpr double kInPlace = 0.25;         // an object this near to its place needs no contact [m]

/// How far the robot is from being able to pull an object along `way`: it must touch the object on
/// the side that `way` points to, within kPullCone of it [m].
double approach(const Task& task, const Poses& poses, std::size_t body, const Vector2d& way) {
  const Vector2d arm = poses[0].position() - poses[body].position();
  const double gap =
      separation(task.scene.bodies[0].shape, poses[0], task.scene.bodies[body].shape, poses[body]);
  const double off = std::acos(std::clamp(arm.normalized().dot(way.normalized()), -1.0, 1.0));
  return std::max(gap, 0.0) + std::max(0.0, off - kPullCone) * arm.norm();
}

/// The same to the next object that is out of place, or to the robot's own place [m].
double next_approach(const Task& task, const StateMetric& metric, const Poses& poses,
                     const Poses& target) {
  double best = std::numeric_limits<double>::infinity();
  for (const auto& o : metric.objects()) {
    const Vector2d way = target[o.body].position() - poses[o.body].position();
    if (way.norm() > kInPlace) best = std::min(best, approach(task, poses, o.body, way));
  }
  return std::isfinite(best) ? best : (target[0].position() - poses[0].position()).norm();
}

double displacement(const Candidate& c) {
  double sum = 0.0;
  for (std::size_t k = 1; k < c.start.size(); ++k)
    sum += (c.start[k].position() - c.end[k].position()).norm();
  return sum;
}

Score novelty(const StateMetric& metric, std::span<const Poses> known) {
  std::unordered_map<std::uint64_t, int> visits;
  for (const Poses& poses : known) ++visits[metric.cell(poses, {})];
  return [metric, visits = std::move(visits)](const Candidate& c) {
    const auto found = visits.find(metric.cell(c.start, {}));
    return found == visits.end() ? 0.0 : static_cast<double>(found->second);
  };
}

}  // namespace

double start_distance(const Task& task, const StateMetric& metric, const Poses& poses,
                      const Poses& target) {
  return metric.layout_distance(poses, target) +
         kApproachWeight * next_approach(task, metric, poses, target);
}

Score make_score(Ranking ranking, const Task& task, const Poses& target,
                 std::span<const Poses> known) {
  StateMetric metric(task.scene);
  switch (ranking) {
    case Ranking::kNovelty:
      return novelty(metric, known);
    case Ranking::kDisplacement:
      return [](const Candidate& c) { return -displacement(c); };
    case Ranking::kStartDistance:
      break;
  }
  return [task, metric, target](const Candidate& c) {
    return start_distance(task, metric, c.start, target);
  };
}

}  // namespace rtg

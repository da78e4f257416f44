#include "core/search/state_metric.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/math/hash.hpp"
#include "core/tasks/symmetry.hpp"

namespace rtg::search {
namespace {

constexpr double kRobotCell = 0.8;   // side of a cell [m]
constexpr double kObjectCell = 0.4;  // side of a cell [m], [rad]
constexpr double kGateCell = 0.2;    // gates in one cell count as equal [m], [rad]
constexpr double kSnug = 0.9;  // clearance of a way around walls / half the least width of a body
constexpr double kAngleRadius = 0.5;  // r [m], about the radius of gyration of a 1.2 m box

std::int64_t slot(double x, double side) { return static_cast<std::int64_t>(std::floor(x / side)); }

std::uint64_t with_slot(std::uint64_t hash, std::int64_t number) {
  return hashed(hash, static_cast<std::uint64_t>(number));
}

}  // namespace

StateMetric::StateMetric(const Scene& scene) {
  for (std::size_t k = 1; k < scene.size(); ++k) {
    if (!scene.bodies[k].fixed)
      objects_.push_back({k, has_joint(scene, k), tasks::turn_period(scene, k)});
  }
}

StateMetric::StateMetric(const tasks::Task& task, std::span<const double> paces)
    : StateMetric(task.scene) {
  if (!paces.empty())
    for (Object& o : objects_) o.pace = paces[o.body];
  const std::vector<Body>& bodies = task.scene.bodies;
  if (std::ranges::none_of(bodies, &Body::fixed)) return;
  task_ = task;
  const std::vector<std::size_t> roots = roots_of(task.scene);
  std::vector<std::size_t> walls;
  for (std::size_t k = 1; k < bodies.size(); ++k) {
    if (bodies[k].fixed) walls.push_back(k);
    if (!bodies[k].fixed && bodies[roots[k]].fixed) gates_.push_back(k);
  }
  std::vector<std::size_t> all = walls;
  all.insert(all.end(), gates_.begin(), gates_.end());
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    movers_.emplace_back();
    if (bodies[k].fixed || has_joint(task.scene, k)) continue;
    const double clearance = kSnug * least_half_width(bodies[k].shape);
    movers_[k] = Mover{
        clearance,
        k == 0 ? walls : all,
        gates_.empty() ? Ways() : Ways(task.scene, task.start, walls, clearance, task.push.arena),
        {}};
  }
}

Ways::Way StateMetric::way(std::size_t body, const Poses& poses, const Vector2d& a,
                           const Vector2d& b) const {
  if (movers_.empty() || !movers_[body]) return {(a - b).norm(), b};
  const Mover& mover = *movers_[body];
  std::uint64_t key = 0;
  if (body > 0)
    for (const std::size_t gate : gates_) {
      key = with_slot(key, slot(poses[gate].x, kGateCell));
      key = with_slot(key, slot(poses[gate].y, kGateCell));
      key = with_slot(key, slot(poses[gate].theta, kGateCell));
    }
  auto found = mover.ways.find(key);
  if (found == mover.ways.end())
    found = mover.ways
                .emplace(key, Ways(task_->scene, poses, mover.obstacles, mover.clearance,
                                   task_->push.arena))
                .first;
  return found->second.between(a, b);
}

Poses StateMetric::opened(std::size_t gate, Poses poses, const Poses& target) const {
  for (const Joint& joint : task_->scene.joints) {
    if (static_cast<std::size_t>(joint.child) != gate) continue;
    const double place = joint_value(joint, target);
    const double open = joint.upper - place > place - joint.lower ? joint.upper : joint.lower;
    set_joint_value(joint, std::isfinite(open) ? open : place + std::numbers::pi / 2.0, poses);
  }
  return poses;
}

double StateMetric::detour(const Object& o, const Poses& a, const Poses& b) const {
  if (gates_.empty() || !movers_[o.body]) return 0.0;
  const Vector2d from = a[o.body].position(), to = b[o.body].position();
  return way(o.body, a, from, to).length - movers_[o.body]->without_gates.between(from, to).length;
}

/// Returns r|θ_a - θ_b|.
double StateMetric::turn_between(const Object& o, const Poses& a, const Poses& b) const {
  if (o.turn == 0.0) return 0.0;
  return kAngleRadius * std::abs(std::remainder(a[o.body].theta - b[o.body].theta, o.turn));
}

double StateMetric::distance(const Object& o, const Poses& a, const Poses& b) const {
  return (a[o.body].position() - b[o.body].position()).norm() + turn_between(o, a, b);
}

double StateMetric::distance_around(const Object& o, const Poses& a, const Poses& b) const {
  return way(o.body, a, a[o.body].position(), b[o.body].position()).length + turn_between(o, a, b);
}

double StateMetric::layout_distance(const Poses& a, const Poses& b) const {
  double sum = 0.0;
  for (const Object& o : objects_) sum += distance(o, a, b);
  return sum;
}

std::uint64_t StateMetric::layout_cell(const Poses& poses) const {
  std::uint64_t hash = 0;
  for (const Object& o : objects_) {
    const Pose& p = poses[o.body];
    const auto slots = std::max<std::int64_t>(1, std::llround(o.turn / kObjectCell));
    const double side = o.turn / static_cast<double>(slots);
    const std::int64_t turn = side > 0.0 ? slot(p.theta, side) : 0;
    hash = with_slot(hash, slot(p.x, kObjectCell));
    hash = with_slot(hash, slot(p.y, kObjectCell));
    hash = with_slot(hash, ((turn % slots) + slots) % slots);
  }
  return hash;
}

std::uint64_t StateMetric::cell(const Poses& poses) const {
  const std::uint64_t hash = with_slot(layout_cell(poses), slot(poses[0].x, kRobotCell));
  return with_slot(hash, slot(poses[0].y, kRobotCell));
}

}  // namespace rtg::search

#include "core/forward/newton_simulator.hpp"

#include <cmath>
#include <utility>

#include "core/energy/implicit_step.hpp"
#include "core/energy/open_gaps.hpp"
#include "core/world/selection.hpp"

namespace rtg::forward {

NewtonSimulator::NewtonSimulator(Scene scene, const PushConfig& push, const PhysicsConfig& physics)
    : scene_(std::move(scene)),
      push_(push),
      sub_steps_(physics.sub_steps),
      settling_(static_cast<std::size_t>(physics.settling_steps())),
      order_(movable_first(scene_)),
      energy_(select(scene_, Poses(scene_.size()), order_).scene, physics, push) {}

PushOutcome NewtonSimulator::push(const Poses& start, int action) const {
  if (start.size() != scene_.size()) return {start, false};
  const Pose goal = push_target(start[0], action, push_);
  const Vector3d from(start[0].x, start[0].y, start[0].theta), to(goal.x, goal.y, goal.theta);
  std::vector<Vector3d> targets;
  for (int k = 1; k <= sub_steps_; ++k)
    targets.push_back(from + static_cast<double>(k) / sub_steps_ * (to - from));
  targets.resize(targets.size() + settling_, to);
  return follow(start, targets);
}

PushOutcome NewtonSimulator::settle(const Poses& start) const {
  if (start.size() != scene_.size()) return {start, false};
  const Vector3d hold(start[0].x, start[0].y, start[0].theta);
  return follow(start, {static_cast<std::size_t>(sub_steps_) + settling_, hold});
}

PushOutcome NewtonSimulator::follow(const Poses& start,
                                    const std::vector<Vector3d>& targets) const {
  if (!is_finite(start)) return {start, false};
  VectorXd p = with_open_gaps(energy_, energy::stacked(select(scene_, start, order_).poses));
  VectorXd before = p, forces = energy_.start_forces(p);
  for (const Vector3d& target : targets) {
    const auto step =
        implicit_step(energy_, {p, forces, &before}, energy::Drive<double>::towards(target));
    if (!step) return {start, false};
    before = std::exchange(p, step->next);
    forces = energy_.forces(p);
  }
  return {merged(start, energy::unstacked(p), order_), true};
}

}  // namespace rtg::forward

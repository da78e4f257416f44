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
      order_(movable_first(scene_)) {
  const Scene ordered = select(scene_, Poses(scene_.size()), order_).scene;
  for (int action = 0; action < action_count(push); action += push.headings)
    energies_.emplace_back(ordered, physics, with_stride_of(action, push));
}

PushOutcome NewtonSimulator::push(const Poses& start, int action) const {
  if (start.size() != scene_.size()) return {start, false};
  const Pose goal = push_target(start[0], action, push_);
  const Vector3d from(start[0].x, start[0].y, start[0].theta), to(goal.x, goal.y, goal.theta);
  std::vector<Vector3d> targets;
  for (int k = 1; k <= sub_steps_; ++k)
    targets.push_back(from + static_cast<double>(k) / sub_steps_ * (to - from));
  targets.resize(targets.size() + settling_, to);
  return follow(start, targets, energies_[static_cast<std::size_t>(stride_index(action, push_))]);
}

PushOutcome NewtonSimulator::settle(const Poses& start) const {
  if (start.size() != scene_.size()) return {start, false};
  const Vector3d hold(start[0].x, start[0].y, start[0].theta);
  return follow(start, {static_cast<std::size_t>(sub_steps_) + settling_, hold}, energies_[0]);
}

PushOutcome NewtonSimulator::follow(const Poses& start, const std::vector<Vector3d>& targets,
                                    const energy::StepEnergy& energy) const {
  if (!is_finite(start)) return {start, false};
  VectorXd p = with_open_gaps(energy, energy::stacked(select(scene_, start, order_).poses));
  VectorXd before = p, forces = energy.start_forces(p);
  for (const Vector3d& target : targets) {
    const auto step =
        implicit_step(energy, {p, forces, &before}, energy::Drive<double>::towards(target));
    if (!step) return {start, false};
    before = std::exchange(p, step->next);
    forces = energy.forces(p);
  }
  return {merged(start, energy::unstacked(p), order_), true};
}

}  // namespace rtg::forward

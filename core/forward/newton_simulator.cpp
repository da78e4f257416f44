#include "core/forward/newton_simulator.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/energy/implicit_step.hpp"
#include "core/energy/open_gaps.hpp"
#include "core/world/selection.hpp"

namespace rtg::forward {

NewtonSimulator::NewtonSimulator(Scene scene, const PushConfig& push, const PhysicsConfig& physics)
    : Simulator(push),
      scene_(std::move(scene)),
      physics_(physics),
      settling_(static_cast<std::size_t>(physics.settling_steps())),
      order_(movable_first(scene_)) {
  for (const double stride : push.strides) energies_.push_back(energy_of(stride));
}

energy::StepEnergy NewtonSimulator::energy_of(double stride) const {
  PushConfig push = push_;
  push.strides = {stride};
  return {select(scene_, Poses(scene_.size()), order_).scene, physics_, push};
}

PushOutcome NewtonSimulator::push_along(const Poses& start, const Stroke& stroke) const {
  if (start.size() != scene_.size()) return {start, false};
  const Pose goal = push_target(start[0], stroke, push_);
  const Vector3d from(start[0].x, start[0].y, start[0].theta), to(goal.x, goal.y, goal.theta);
  std::vector<Vector3d> targets;
  for (int k = 1; k <= physics_.sub_steps; ++k)
    targets.push_back(from + static_cast<double>(k) / physics_.sub_steps * (to - from));
  targets.resize(targets.size() + settling_, to);
  const auto at = std::ranges::find(push_.strides, stroke.length);
  if (at == push_.strides.end()) return follow(start, targets, energy_of(stroke.length));
  return follow(start, targets,
                energies_[static_cast<std::size_t>(std::distance(push_.strides.begin(), at))]);
}

PushOutcome NewtonSimulator::settle(const Poses& start) const {
  if (start.size() != scene_.size()) return {start, false};
  const Vector3d hold(start[0].x, start[0].y, start[0].theta);
  return follow(start, {static_cast<std::size_t>(physics_.sub_steps) + settling_, hold},
                energies_[0]);
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

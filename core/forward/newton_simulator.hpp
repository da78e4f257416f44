#pragma once

#include <vector>

#include "core/energy/step_energy.hpp"
#include "core/forward/simulator.hpp"

namespace rtg::forward {

/// Forward simulation, eq. (5): every sub-step minimises Ψ, the robot on a bounded servo along the
/// straight path; in dynamic mode (PhysicsConfig::inertia) from rest and with sub-steps in which
/// what still moves comes to rest. The model that the reverse simulator inverts; the true dynamics
/// is Box2dSimulator.
class NewtonSimulator final : public Simulator {
 public:
  /// `scene`: legal shapes only (polygon_defect() empty), bodies[0] movable.
  NewtonSimulator(Scene scene, const PushConfig& push, const PhysicsConfig& physics);

  /// As Simulator::push. Without inertia everything is at rest after the last sub-step, with it the
  /// speeds of free bodies are less than a hundredth of what they were when the robot stopped. Not
  /// ok: `start` has the wrong size, is not finite, overlaps, or a sub-step failed.
  [[nodiscard]] PushOutcome push(const Poses& start, int action) const override;

  /// As Simulator::settle, for the time of one push.
  [[nodiscard]] PushOutcome settle(const Poses& start) const override;

 private:
  PushOutcome follow(const Poses& start, const std::vector<Vector3d>& targets) const;

  Scene scene_;
  PushConfig push_;
  int sub_steps_;
  std::size_t settling_;    // sub-steps
  std::vector<int> order_;  // of the bodies in energy_
  energy::StepEnergy energy_;
};

}  // namespace rtg::forward

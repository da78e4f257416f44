#pragma once

#include <vector>

#include "core/energy/step_energy.hpp"
#include "core/forward/simulator.hpp"

namespace rtg::forward {

/// Forward simulation, eq. (5): each sub-step minimises Ψ while a bounded servo drives the robot
/// along its straight path. In dynamic mode (PhysicsConfig::inertia) all bodies start at rest, and
/// further sub-steps let moving bodies come to rest. The reverse simulator inverts this model; the
/// true dynamics are those of Box2dSimulator.
class NewtonSimulator final : public Simulator {
 public:
  /// All shapes of `scene` must be legal (polygon_defect() empty) and bodies[0] movable.
  NewtonSimulator(Scene scene, const PushConfig& push, const PhysicsConfig& physics);

  /// See Simulator::push. Without inertia everything is at rest after the last sub-step. With
  /// inertia, the speeds of free bodies are then at most a hundredth of those when the robot
  /// stopped. `ok` is false if `start` has the wrong size, is not finite or overlaps, or if a
  /// sub-step failed; `end` is then `start`.
  [[nodiscard]] PushOutcome push(const Poses& start, int action) const override;

  /// See Simulator::settle. Simulates the duration of one push.
  [[nodiscard]] PushOutcome settle(const Poses& start) const override;

 private:
  /// Simulates one sub-step for each target pose of the servo.
  PushOutcome follow(const Poses& start, const std::vector<Vector3d>& targets) const;

  Scene scene_;
  PushConfig push_;
  int sub_steps_;
  std::size_t settling_;    // number of sub-steps after the robot has stopped
  std::vector<int> order_;  // the bodies of scene_ in the order of energy_
  energy::StepEnergy energy_;
};

}  // namespace rtg::forward

#pragma once

#include <vector>

#include "core/energy/step_energy.hpp"
#include "core/forward/simulator.hpp"

namespace rtg::forward {

/// Forward simulation with the step energy Ψ, eq. (5): the model that the reverse simulator
/// inverts. The true dynamics are those of Box2dSimulator. Each sub-step minimises Ψ while a
/// bounded servo drives the robot along its straight path.
///
/// In dynamic mode (PhysicsConfig::inertia) all bodies start at rest. Further sub-steps then follow
/// the push, in which moving bodies come to rest.
class NewtonSimulator final : public Simulator {
 public:
  /// All shapes of `scene` must be legal (polygon_defect() returns nothing), and bodies[0] movable.
  NewtonSimulator(Scene scene, const PushConfig& push, const PhysicsConfig& physics);

  /// See Simulator::push_along. Without inertia everything is at rest after the last sub-step. With
  /// inertia the sub-steps after the robot's stop reduce the speed of a free body to 1 % or less.
  ///
  /// `ok` is false if `start` has the wrong size, is not finite or overlaps deeply, or if a
  /// sub-step failed. `end` is then `start`.
  [[nodiscard]] PushOutcome push_along(const Poses& start, const Stroke& stroke) const override;

  /// See Simulator::settle. Simulates as many sub-steps as a push has.
  [[nodiscard]] PushOutcome settle(const Poses& start) const override;

 private:
  energy::StepEnergy energy_of(double stride) const;

  /// Simulates one sub-step for each element of `targets`, the target poses (x, y, θ) of the servo.
  PushOutcome follow(const Poses& start, const std::vector<Vector3d>& targets,
                     const energy::StepEnergy& energy) const;

  Scene scene_;
  PhysicsConfig physics_;
  std::size_t settling_;                      // number of sub-steps after the robot has stopped
  std::vector<int> order_;                    // the bodies of scene_ in the order of energies_
  std::vector<energy::StepEnergy> energies_;  // of each of the strides in push_
};

}  // namespace rtg::forward

#pragma once

#include <optional>

#include "core/energy/step_energy.hpp"

namespace rtg {

/// Error over which the servo builds up its force, as a share of the sub-step's stride.
inline constexpr double kServoShare = 0.05;

/// What drives the robot in a sub-step: given controls, or a bounded servo towards a target pose,
/// the potential B s ln cosh(e/s) of the error e = target - p₊₀, whose force B tanh(e/s) is that
/// of the control c = e/s.
struct Drive {
  Vector3d control = Vector3d::Zero();  // c, before tanh
  bool servo = false;
  Vector3d target = Vector3d::Zero();  // [m], [m], [rad]

  static Drive controls(const Vector3d& c) { return {c, false, Vector3d::Zero()}; }
  static Drive towards(const Vector3d& target) { return {Vector3d::Zero(), true, target}; }
};

/// One quasi-static sub-step, eq. (5): p₊ = argmin Ψ(·, p) under the drive.
struct ImplicitStep {
  VectorXd next;     // p₊ [3·bodies]
  Vector3d control;  // c that the drive amounted to
  int iterations = 0;
};

/// Scale s of the servo's error [m], [m], [rad].
Vector3d servo_scale(const StepEnergy& energy);

/// Newton's method with line search from `now`, whose gaps must be positive; `lag` are the normal
/// forces there [contacts]. Ends at ‖∂Ψ/∂p₊‖∞ < 1e-10 kg m. Nothing if it does not get there.
std::optional<ImplicitStep> implicit_step(const StepEnergy& energy, const VectorXd& now,
                                          const VectorXd& lag, const Drive& drive);

}  // namespace rtg

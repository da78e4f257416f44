#pragma once

#include <optional>

#include "core/energy/forward_step.hpp"
#include "core/energy/step_energy.hpp"

namespace rtg::energy {

/// Solution of a sub-step, eq. (5): p₊ = argmin Ψ(·, p, p₋) under a drive.
struct ImplicitStep {
  VectorXd next;     // p₊ [3·bodies]
  Vector3d control;  // c, the control equivalent to the drive at p₊
};

/// Solves the sub-step that starts at `from` to a tolerance of 1e-10 kg m (ForwardStep). Returns
/// nothing if Newton's method does not converge. All gaps at the start must be positive.
std::optional<ImplicitStep> implicit_step(const StepEnergy& energy, const StepFrom& from,
                                          const Drive<double>& drive);

}  // namespace rtg::energy

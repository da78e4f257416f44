#pragma once

#include <optional>

#include "core/energy/forward_step.hpp"
#include "core/energy/step_energy.hpp"

namespace rtg::energy {

/// A sub-step of one scene, eq. (5): p₊ = argmin Ψ(·, p, p₋) under the drive.
struct ImplicitStep {
  VectorXd next;     // p₊ [3·bodies]
  Vector3d control;  // c that the drive amounted to
};

/// From poses whose gaps must be positive. Ends at ‖∂Ψ/∂p₊‖∞ < 1e-10 kg m. Nothing if it does not
/// get there.
std::optional<ImplicitStep> implicit_step(const StepEnergy& energy, const StepFrom& from,
                                          const Drive<double>& drive);

}  // namespace rtg::energy

#pragma once

#include "core/energy/step_energy.hpp"

namespace rtg::energy {

/// Least gap that a start of Newton's method is given, as a share of the barrier's range ĝ.
inline constexpr double kGapFloor = 0.03;

/// Least gap of all contacts in `p` [3·bodies], at most ĝ [m].
double least_gap(const StepEnergy& energy, const VectorXd& p);

/// `p` with bodies moved apart along the gradients of gaps below kGapFloor ĝ: Box2D lets resting
/// bodies overlap by its slop, the barrier does not. Joints are closed.
VectorXd with_open_gaps(const StepEnergy& energy, const VectorXd& p);

}  // namespace rtg::energy

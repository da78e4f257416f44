#pragma once

#include "core/energy/step_energy.hpp"

namespace rtg::energy {

/// Least gap at the start of Newton's method, as a share of the barrier's range ĝ.
inline constexpr double kGapFloor = 0.03;

/// Returns the least gap of all contacts at poses `p` [3·bodies], at most ĝ [m].
double least_gap(const StepEnergy& energy, const VectorXd& p);

/// Returns `p` with joints closed and bodies moved apart along the gradients of gaps below
/// kGapFloor ĝ. Box2D lets resting bodies overlap by its slop; the barrier does not.
VectorXd with_open_gaps(const StepEnergy& energy, const VectorXd& p);

}  // namespace rtg::energy

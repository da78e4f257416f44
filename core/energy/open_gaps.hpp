#pragma once

#include "core/energy/step_energy.hpp"

namespace rtg::energy {

/// Least gap at the start of Newton's method, as a fraction of the barrier's range ĝ.
inline constexpr double kGapFloor = 0.03;

/// Returns the least gap of all contacts at poses `p` [3·bodies], but at most ĝ [m].
double least_gap(const StepEnergy& energy, const VectorXd& p);

/// Returns the poses `p` with joints closed and with bodies moved apart where a gap is below
/// kGapFloor ĝ. The motion follows the gradient of the gap.
///
/// Departs from the paper: it takes the final state as it is. The barrier needs positive gaps, and
/// Box2D leaves bodies that touch with gaps on either side of 0.
VectorXd with_open_gaps(const StepEnergy& energy, const VectorXd& p);

}  // namespace rtg::energy

#pragma once

#include "core/reverse/problem/reverse_problem.hpp"

namespace rtg::reverse {

/// Returns the mean pace, the speed of the robot as a share of that without a load (paces()), of a
/// push that moves the bodies as the solution `x` of `problem` does, but with the robot's largest
/// force wherever it lags behind its stroke. With the force f_k along the push, as a share of B_f,
///
///   1 - lag_h / h,   lag_k = max(0, lag_{k-1} + 1 - σ / f_k),   lag_0 = 0.
double sustained_pace(const ReverseProblem& problem, const Iterate& x);

}  // namespace rtg::reverse

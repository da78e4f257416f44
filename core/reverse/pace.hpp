#pragma once

#include "core/reverse/problem/reverse_problem.hpp"

namespace rtg::reverse {

// A push whose load asks for more than the robot's largest force is slow: the robot ends short of
// its stroke. The pace σ is its speed as a share of that without such a load
// (ReverseProblem::pace). With linear damping the force of a quasi-static push is proportional to
// its speed.

/// Returns the pace of a robot of mass m₀ that pushes the heaviest body without joints, of mass m,
/// with almost all of its force:
///
///   min(1, 0.99 B_f / (s (m₀ + m))),   s: stride of a sub-step.
///
/// `scene` holds the bodies of the problem. Returns 1 if κ_x = 0: then the path does not hold the
/// robot.
double least_pace(const ReverseProblem& problem, const Scene& scene);

/// Returns the mean pace of a push that moves the bodies as the solution `x` of `problem` does, but
/// with the robot's largest force wherever it lags behind its stroke. With the force f_k along the
/// push, as a share of B_f,
///
///   1 - lag_h / h,   lag_k = max(0, lag_{k-1} + 1 - σ / f_k),   lag_0 = 0.
double sustained_pace(const ReverseProblem& problem, const Iterate& x);

}  // namespace rtg::reverse

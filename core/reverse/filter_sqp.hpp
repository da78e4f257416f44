#pragma once

#include "core/reverse/sqp_result.hpp"

namespace rtg {

/// The default SQP: Newton steps on the relaxed problem with a proximal term δ,
/// globalised by a filter line search [Wächter & Biegler 2006] with second-order correction. δ
/// falls on full steps, rises when no step is acceptable or the model has negative curvature, and
/// once it is small the exact Hessian of the Lagrangian takes over.
SqpResult filter_sqp(const ReverseProblem& problem, const Iterate& start, int max_iterations,
                     double proximal);

}  // namespace rtg

#pragma once

#include "core/reverse/sqp_result.hpp"

namespace rtg {

/// The default SQP: Newton steps on the relaxed problem with the exact Hessian of the Lagrangian
/// and a proximal term δ, globalised by a filter line search [Fletcher & Leyffer 2002]. Where the
/// exact model has no positive curvature along its step, the Hessian of the objective takes its
/// place, which has. δ falls on full steps and rises on short ones or if none is acceptable.
SqpResult filter_sqp(const ReverseProblem& problem, const Iterate& start, int max_iterations,
                     double proximal);

}  // namespace rtg

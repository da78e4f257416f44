#pragma once

#include "core/reverse/sqp/sqp_result.hpp"

namespace rtg::reverse {

/// The paper's SQP, A.2: steps of the quadratic model with the objective's Hessian, l1 merit with
/// weight above the multipliers, Armijo line search, eq. (11), and the feasibility safeguard: a
/// step must not leave ‖C‖₁ ≤ ε_c, once there. The baseline of every comparison.
SqpResult merit_sqp(const ReverseProblem& problem, const Iterate& start);

}  // namespace rtg::reverse

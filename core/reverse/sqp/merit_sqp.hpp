#pragma once

#include "core/reverse/sqp/sqp_result.hpp"

namespace rtg::reverse {

/// Solves `problem` with the paper's SQP, A.2: quadratic model with the Hessian of the objective,
/// l1 merit function with a weight above the multipliers, Armijo line search, eq. (11), and the
/// feasibility safeguard. The safeguard rejects a step that raises ‖C‖₁ to a value above ε_c. This
/// SQP is the baseline of every comparison.
SqpResult merit_sqp(const ReverseProblem& problem, const Iterate& start);

}  // namespace rtg::reverse

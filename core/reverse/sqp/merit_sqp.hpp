#pragma once

#include "core/reverse/sqp/sqp_result.hpp"

namespace rtg::reverse {

/// Solves `problem` with the SQP of the paper (A.2), the baseline of every comparison. It uses the
/// Hessian of the objective, an l1 merit function with a weight above the multipliers, and an
/// Armijo line search, eq. (11). The feasibility safeguard rejects a step that raises ‖C‖₁ to a
/// value above ε_c.
SqpResult merit_sqp(const ReverseProblem& problem, const Iterate& start);

}  // namespace rtg::reverse

#pragma once

#include "core/reverse/sqp_result.hpp"

namespace rtg {

/// filter_sqp() from the warm start and, where it gets stuck, once more from there with a larger
/// proximal term, which takes another way. Where the final state is fixed, the trajectory is given
/// that end. kInfeasible if there is no warm start. A solution may miss a final state that a spring
/// holds: see terminal_miss().
SqpResult solve_with_restarts(const ReverseProblem& problem);

}  // namespace rtg

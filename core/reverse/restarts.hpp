#pragma once

#include "core/reverse/sqp_result.hpp"

namespace rtg {

/// filter_sqp() from the warm start, or from the static iterate if there is none, and where it gets
/// stuck, twice more from the same start with ever larger proximal terms, which take other ways.
/// Where the final state is fixed, the trajectory is given that end. kInfeasible if bodies overlap
/// in the final state. A solution may miss a final state that a spring holds: see terminal_miss().
SqpResult solve_with_restarts(const ReverseProblem& problem);

}  // namespace rtg

#pragma once

#include "core/reverse/sqp_result.hpp"

namespace rtg {

/// filter_sqp() from the warm start, with a restoration phase: when it gets stuck, forward
/// simulations of mixtures between the best feasible trajectory and the stuck one give a better
/// feasible trajectory to go on from, with a larger proximal term. Where the final state is fixed,
/// every trajectory is given that end. kInfeasible if there is no warm start. A solution may miss a
/// final state that a spring holds: see terminal_miss().
SqpResult solve_with_restoration(const ReverseProblem& problem);

}  // namespace rtg

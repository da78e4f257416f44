#pragma once

#include "core/reverse/problem/reverse_problem.hpp"
#include "core/reverse/problem/solve_status.hpp"

namespace rtg::reverse {

/// Result of an SQP run. `x` is the last iterate. It is the static iterate if bodies overlap in the
/// final state.
struct SqpResult {
  SolveStatus status = SolveStatus::kNonFinite;
  Iterate x;
  int iterations = 0;          // also those without an accepted step
  double infeasibility = 0.0;  // ‖C‖∞
  double stationarity = 0.0;   // ‖∇L‖∞
};

}  // namespace rtg::reverse

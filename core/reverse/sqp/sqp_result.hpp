#pragma once

#include "core/reverse/problem/reverse_problem.hpp"
#include "core/reverse/problem/solve_status.hpp"

namespace rtg::reverse {

/// How an SQP run ended. `x`: the last iterate of the attempt that counts; the static one if bodies
/// overlap in the end.
struct SqpResult {
  SolveStatus status = SolveStatus::kNonFinite;
  Iterate x;
  int iterations = 0;  // steps looked for, in all attempts
  int attempts = 1;
  double infeasibility = 0.0;  // ‖C‖∞
  double stationarity = 0.0;   // ‖∇L‖∞
};

}  // namespace rtg::reverse

#include "core/reverse/restarts.hpp"

#include <utility>

#include "core/reverse/filter_sqp.hpp"
#include "core/reverse/rollout.hpp"

namespace rtg {
namespace {

constexpr int kAttempts = 3;
constexpr double kProximalGrowth = 4.0;  // per attempt

/// `x`, made to end in the given final state where that is fixed: a forward simulation ends near
/// it.
Iterate with_fixed_end(const ReverseProblem& problem, Iterate x) {
  if (!problem.fixed_end()) return x;
  x.p.back() = problem.end;
  x.forces.back() = problem.energy.forces(problem.end);
  return x;
}

}  // namespace

SqpResult solve_with_restarts(const ReverseProblem& problem) {
  SqpResult result{SolveStatus::kInfeasible, static_iterate(problem), 0, 0.0, 0.0};
  std::optional<Iterate> start = warm_start(problem);
  if (!start) return result;
  start = with_fixed_end(problem, *std::move(start));
  int iterations = 0;
  double proximal = problem.config.proximal_start;
  for (int attempt = 0; attempt < kAttempts; ++attempt, proximal *= kProximalGrowth) {
    result = filter_sqp(problem, *start, problem.config.max_iterations - iterations, proximal);
    iterations += result.iterations;
    if (result.status == SolveStatus::kConverged || iterations >= problem.config.max_iterations)
      break;
  }
  result.iterations = iterations;
  return result;
}

}  // namespace rtg

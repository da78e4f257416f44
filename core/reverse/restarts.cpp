#include "core/reverse/restarts.hpp"

#include <cmath>
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
  const VectorXd none = VectorXd::Zero(result.x.forces[0].size());
  if (!std::isfinite(problem.energy.value(problem.end, problem.end, none))) return result;
  const Iterate start =
      with_fixed_end(problem, warm_start(problem).value_or(static_iterate(problem)));
  int iterations = 0;
  double proximal = problem.config.proximal_start;
  for (int attempt = 0; attempt < kAttempts; ++attempt, proximal *= kProximalGrowth) {
    result = filter_sqp(problem, start, problem.config.max_iterations - iterations, proximal);
    iterations += result.iterations;
    if (result.status == SolveStatus::kConverged || iterations >= problem.config.max_iterations)
      break;
  }
  result.iterations = iterations;
  return result;
}

}  // namespace rtg

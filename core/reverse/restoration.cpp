#include "core/reverse/restoration.hpp"

#include <limits>
#include <utility>

#include "core/reverse/filter_sqp.hpp"
#include "core/reverse/rollout.hpp"

namespace rtg {
namespace {

constexpr int kAttempts = 6;
constexpr double kProximalGrowth = 4.0;  // per attempt
constexpr double kShares[] = {1.0, 0.5, 0.25, 0.1};

/// A forward simulation on the way from `feasible` to `stuck` that is better than `feasible` and,
/// where no spring makes that a matter of the objective, ends no farther from the given final
/// state; `feasible` itself if there is none.
Iterate restored(const ReverseProblem& problem, const Iterate& feasible, const Iterate& stuck) {
  const double best = objective(problem, feasible);
  const double miss = problem.fixed_end() ? terminal_miss(problem, feasible)
                                          : std::numeric_limits<double>::infinity();
  const ServoTargets from = servo_targets(problem, feasible), to = servo_targets(problem, stuck);
  for (const double share : kShares) {
    const VectorXd start = (1.0 - share) * feasible.p[0] + share * stuck.p[0];
    if (!problem.energy.separated(start)) continue;
    ServoTargets targets = from;
    for (std::size_t k = 0; k < targets.size(); ++k) targets[k] += share * (to[k] - from[k]);
    std::optional<Iterate> rolled = roll_out(problem, start, targets);
    if (rolled && objective(problem, *rolled) < best && terminal_miss(problem, *rolled) <= miss)
      return std::move(*rolled);
  }
  return feasible;
}

/// `x`, made to end in the given final state where that is fixed: a forward simulation ends near
/// it.
Iterate with_fixed_end(const ReverseProblem& problem, Iterate x) {
  if (!problem.fixed_end()) return x;
  x.p.back() = problem.end;
  x.forces.back() = problem.energy.forces(problem.end);
  return x;
}

}  // namespace

SqpResult solve_with_restoration(const ReverseProblem& problem) {
  SqpResult result{SolveStatus::kInfeasible, static_iterate(problem), 0, 0.0, 0.0};
  std::optional<Iterate> feasible = warm_start(problem);
  if (!feasible) return result;
  int iterations = 0;
  double proximal = problem.config.proximal_start;
  for (int attempt = 0; attempt < kAttempts; ++attempt, proximal *= kProximalGrowth) {
    result = filter_sqp(problem, with_fixed_end(problem, *feasible),
                        problem.config.max_iterations - iterations, proximal);
    iterations += result.iterations;
    if (result.status == SolveStatus::kConverged || iterations >= problem.config.max_iterations)
      break;
    if (result.status != SolveStatus::kNonFinite && attempt + 1 < kAttempts)
      *feasible = restored(problem, *feasible, result.x);
  }
  result.iterations = iterations;
  return result;
}

}  // namespace rtg

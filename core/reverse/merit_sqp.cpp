#include "core/reverse/merit_sqp.hpp"

#include <cmath>
#include <memory>

#include "core/reverse/merit.hpp"
#include "core/reverse/trial.hpp"

namespace rtg {
namespace {

constexpr double kArmijo = 1e-4;
constexpr double kLeastStep = 1e-12;
constexpr double kProximal = 1e-6;  // keeps the poses' Hessian from being singular
constexpr double kSafeguard = 1.0;  // ε_c [kg m]; far less lets even free pushes creep

double largest_multiplier(const Iterate& x, const Direction& d) {
  double top = 0.0;
  for (std::size_t k = 1; k < x.multipliers.size(); ++k)
    top = std::max(top, (x.multipliers[k] + d.multipliers[k]).lpNorm<Eigen::Infinity>());
  return top;
}

/// Backtracking on the merit function, eq. (11), and the safeguard.
std::optional<Iterate> line_search(const ReverseProblem& problem, const Iterate& x,
                                   const Linearisation& lin, const Direction& d,
                                   const Merit& merit) {
  const double violation_now = lin.violation().l1();
  const double now = merit.value(objective(problem, x), violation_now);
  const double slope = merit.slope(lin.objective_slope(d), violation_now);
  for (double alpha = 1.0; alpha >= kLeastStep; alpha *= 0.5) {
    std::optional<Iterate> trial = trial_point(problem, x, d, alpha);
    if (!trial) continue;
    const double left = violation(problem, *trial).l1();
    const double then = merit.value(objective(problem, *trial), left);
    const bool safe = left <= std::max(kSafeguard, violation_now);
    if (safe && then <= now + kArmijo * alpha * slope) return trial;
  }
  return std::nullopt;
}

}  // namespace

SqpResult merit_sqp(const ReverseProblem& problem, const Iterate& start) {
  const ReverseConfig& config = problem.config;
  const std::unique_ptr<KktSolver> kkt = make_kkt_solver(config.kkt);
  SqpResult result{SolveStatus::kNonFinite, start, 0, 0.0, 0.0};
  const auto ended = [&result](SolveStatus status) {
    result.status = status;
    return result;
  };
  Merit merit;
  for (;;) {
    const Linearisation lin(problem, result.x, {false, kProximal});
    result.infeasibility = lin.violation().max();
    result.stationarity = lin.stationarity();
    if (!lin.finite()) return ended(SolveStatus::kNonFinite);
    if (result.infeasibility < config.feasibility_tol &&
        result.stationarity < config.stationarity_tol)
      return ended(SolveStatus::kConverged);
    if (result.iterations == config.max_iterations) return ended(SolveStatus::kIterationLimit);
    ++result.iterations;
    if (!kkt->factorize(lin.matrix())) return ended(SolveStatus::kSingular);
    const BlockVector solution = kkt->solve(lin.right_hand_side(lin.violation()));
    const Direction d = lin.direction(solution, lin.violation());
    merit.raise_weight_above(largest_multiplier(result.x, d));
    std::optional<Iterate> next = line_search(problem, result.x, lin, d, merit);
    if (!next) return ended(SolveStatus::kLineSearchFailed);
    result.x = std::move(*next);
  }
}

}  // namespace rtg

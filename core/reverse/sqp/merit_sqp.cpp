#include "core/reverse/sqp/merit_sqp.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/math/assembled_solver.hpp"
#include "core/reverse/problem/evaluator.hpp"
#include "core/reverse/problem/newton_system.hpp"
#include "core/reverse/problem/trial_point.hpp"
#include "core/reverse/sqp/l1_merit.hpp"

namespace rtg::reverse {
namespace {

constexpr double kArmijo = 1e-4;
constexpr double kLeastStep = 1e-12;
constexpr double kProximal = 1e-6;  // keeps the Hessian over the poses regular
constexpr double kSafeguard = 1.0;  // ε_c [kg m]

/// The SQP of A.2.
///
/// Departs from the paper: in what it cannot mean literally. ‖C‖₁ ≤ ε_c would forbid every step
/// from a start that violates it, so that a step must not raise ‖C‖₁ above the larger of ε_c and
/// its present value; with ε_c from 0.1 to 30 the same pushes are found. Eq. (11) asks for a
/// decrease of more than the slope of the merit function promises, which a convex function never
/// has, so that 1e-4 of it is enough here, with equality; a slope above 0 counts as 0. The Hessian
/// of J over the poses is singular, so that it gets 1e-6 on its diagonal. And a step is refused if
/// it moves a body by more than 1 m or 0.5 rad, or into another, or narrows a gap to less than a
/// tenth both of what it was and of ĝ.
class MeritSqp {
 public:
  MeritSqp(const ReverseProblem& one, const Iterate& start)
      : one_(one),
        problem_(one),
        newton_(problem_),
        kkt_(one.config.kkt, problem_.fixed_end()),
        evaluator_(problem_),
        x_(problem_.energy, one.sub_steps),
        trial_(x_),
        step_(problem_.energy.movable(), one.sub_steps),
        no_force_step_(x_.forces),
        gaps_(x_.forces),
        trial_gaps_(x_.forces) {
    problem_.load(0, one);
    x_.load(0, one, start);
    trial_ = x_;
    for (std::vector<double>& level : gaps_) std::ranges::fill(level, 0.0);
    bool legal = true;
    now_ = evaluator_.evaluate(problem_, x_, gaps_, gaps_, legal);
    if (!legal) now_.objective = INFINITY;
  }

  SqpResult run() {
    const ReverseConfig& config = problem_.config;
    for (int iterations = 0;;) {
      newton_.linearise(problem_, x_, {0.0, kProximal, 1.0});
      const double stationarity = newton_.stationarity();
      const auto ended = [&](SolveStatus status) {
        Iterate x = x_.unload(0, one_);
        if (status == SolveStatus::kConverged) status = status_of_converged(one_, x);
        return SqpResult{status, std::move(x), iterations, now_.infeasibility, stationarity};
      };
      if (!std::isfinite(stationarity + now_.violation + now_.objective))
        return ended(SolveStatus::kNonFinite);
      if (now_.infeasibility < config.feasibility_tol && stationarity < config.stationarity_tol)
        return ended(SolveStatus::kConverged);
      if (iterations == config.max_iterations) return ended(SolveStatus::kIterationLimit);
      ++iterations;
      if (!kkt_.solve(newton_.system(), step_)) return ended(SolveStatus::kSingular);
      merit_.raise_weight_above(largest_multiplier());
      if (!line_search()) return ended(SolveStatus::kLineSearchFailed);
    }
  }

 private:
  double largest_multiplier() const {
    double top = 0.0;
    for (std::size_t k = 1; k < x_.p.size(); ++k)
      for (std::size_t m = 0; m < x_.multipliers[k].size(); ++m)
        top = std::max(top, std::abs(x_.multipliers[k][m] + step_.multipliers[k][m / 3][m % 3]));
    return top;
  }

  /// Halves the step until the merit function decreases enough, eq. (11) with kArmijo, and the
  /// safeguard agrees. Returns whether a trial point was accepted.
  bool line_search() {
    const double before = merit_.value(now_.objective, now_.violation);
    // The Hessian of the plain barrier is not convex, so that a step may lead uphill.
    const double slope =
        std::min(merit_.slope(newton_.objective_slope(problem_, x_, step_), now_.violation), 0.0);
    for (double alpha = 1.0; alpha >= kLeastStep; alpha *= 0.5) {
      bool legal = bounded(step_, alpha);
      if (!legal) continue;
      make_trial(problem_.energy, x_, {step_, no_force_step_, alpha}, trial_);
      for (std::size_t k = 0; k < trial_.p.size(); ++k)
        problem_.energy.forces(trial_.p[k], trial_.forces[k].data(),
                               k == 0 ? problem_.energy.barrier().start_spare() : 0.0);
      const Measures<double> then =
          evaluator_.evaluate(problem_, trial_, gaps_, trial_gaps_, legal);
      if (!legal || then.violation > std::max(kSafeguard, now_.violation)) continue;
      if (!(merit_.value(then.objective, then.violation) <= before + kArmijo * alpha * slope))
        continue;
      std::swap(x_, trial_);
      std::swap(gaps_, trial_gaps_);
      now_ = then;
      return true;
    }
    return false;
  }

  const ReverseProblem& one_;
  ProblemLanes<double> problem_;
  NewtonSystem<double> newton_;
  AssembledSolver kkt_;
  Evaluator<double> evaluator_;
  Trajectory<double> x_, trial_;
  StageStep<double> step_;
  PerContact<double> no_force_step_, gaps_, trial_gaps_;
  Measures<double> now_;
  Merit merit_;
};

}  // namespace

SqpResult merit_sqp(const ReverseProblem& problem, const Iterate& start) {
  return MeritSqp(problem, start).run();
}

}  // namespace rtg::reverse

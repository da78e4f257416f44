#include "core/reverse/filter_sqp.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "core/reverse/filter.hpp"
#include "core/reverse/trial.hpp"

namespace rtg {
namespace {

constexpr double kLeastProximal = 1e-8, kMostProximal = 1e6;
constexpr double kLeastStep = 1e-4;
constexpr double kMostViolation = 0.3;             // θ may not grow beyond it
constexpr double kShortStep = 0.2;                 // a step of at most this makes δ grow
constexpr double kGrowth = 4.0, kShrinkage = 0.1;  // of δ

class FilterSqp {
 public:
  FilterSqp(const ReverseProblem& problem, const Iterate& start, double proximal)
      : problem_(problem),
        kkt_(make_kkt_solver(problem.config.kkt)),
        proximal_(proximal),
        result_{SolveStatus::kIterationLimit, start, 0, 0.0, 0.0} {}

  SqpResult run(int max_iterations) {
    while (!ended()) {
      if (result_.iterations == max_iterations) break;
      ++result_.iterations;
      iterate();
    }
    return std::move(result_);
  }

 private:
  /// Linearises at the iterate and looks for a reason to stop.
  bool ended() {
    if (failed_) return true;
    lin_.emplace(problem_, result_.x, Curvature{true, proximal_});
    result_.infeasibility = lin_->violation().max();
    result_.stationarity = lin_->stationarity();
    if (!lin_->finite()) return stop(SolveStatus::kNonFinite);
    if (result_.infeasibility < problem_.config.feasibility_tol &&
        result_.stationarity < problem_.config.stationarity_tol)
      return stop(SolveStatus::kConverged);
    return false;
  }

  bool stop(SolveStatus status) {
    result_.status = status;
    return failed_ = true;
  }

  void iterate() {
    std::optional<Direction> d = descent();
    if (!d) {
      lin_.emplace(problem_, result_.x, Curvature{false, proximal_});
      d = descent();
    }
    if (!d) return regularise(SolveStatus::kSingular);
    const double alpha = line_search(*d);
    if (alpha == 0.0) return regularise(SolveStatus::kLineSearchFailed);
    if (alpha <= kShortStep) proximal_ *= kGrowth;
    if (alpha > 0.5) proximal_ = std::max(kShrinkage * proximal_, kLeastProximal);
  }

  void regularise(SolveStatus if_hopeless) {
    proximal_ *= kGrowth;
    if (proximal_ > kMostProximal) stop(if_hopeless);
  }

  /// The Newton step; none if the system is singular or the model not convex along the step.
  std::optional<Direction> descent() {
    if (!kkt_->factorize(lin_->matrix())) return std::nullopt;
    const BlockVector solution = kkt_->solve(lin_->right_hand_side(lin_->violation()));
    if (!(lin_->model_curvature(solution) > 0.0)) return std::nullopt;
    return lin_->direction(solution, lin_->violation());
  }

  /// The step length taken; 0 if none is acceptable.
  double line_search(const Direction& d) {
    const Filter::Entry now{lin_->violation().l1(), objective(problem_, result_.x)};
    for (double alpha = 1.0; alpha >= kLeastStep; alpha *= 0.5) {
      std::optional<Iterate> trial = trial_point(problem_, result_.x, d, alpha);
      if (!trial) continue;
      const Filter::Entry then{violation(problem_, *trial).l1(), objective(problem_, *trial)};
      if (!accepts(then, now)) continue;
      filter_.add(now);
      result_.x = *std::move(trial);
      return alpha;
    }
    return 0.0;
  }

  bool accepts(const Filter::Entry& then, const Filter::Entry& now) const {
    return std::isfinite(then.violation + then.objective) &&
           then.violation <= std::max(kMostViolation, now.violation) && filter_.accepts(then) &&
           Filter::improves(then, now);
  }

  const ReverseProblem& problem_;
  std::unique_ptr<KktSolver> kkt_;
  double proximal_;
  Filter filter_;
  std::optional<Linearisation> lin_;
  bool failed_ = false;
  SqpResult result_;
};

}  // namespace

SqpResult filter_sqp(const ReverseProblem& problem, const Iterate& start, int max_iterations,
                     double proximal) {
  return FilterSqp(problem, start, proximal).run(max_iterations);
}

}  // namespace rtg

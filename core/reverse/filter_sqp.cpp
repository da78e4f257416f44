#include "core/reverse/filter_sqp.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "core/reverse/filter.hpp"
#include "core/reverse/trial.hpp"

namespace rtg {
namespace {

constexpr double kLeastProximal = 1e-4, kMostProximal = 1e6;
constexpr double kLeastStep = 1e-4;
constexpr double kArmijo = 1e-4;
constexpr double kSmallViolation = 1e-2;           // above it, the objective alone decides nothing
constexpr double kMostViolation = 0.3;             // θ may not grow beyond it
constexpr double kShortStep = 0.3;                 // a step of at most this makes δ grow
constexpr double kGrowth = 8.0, kShrinkage = 0.1;  // of δ
constexpr double kExactBand = 10.0;  // exact Hessians last until δ exceeds so many exact_below

class FilterSqp {
 public:
  FilterSqp(const ReverseProblem& problem, const Iterate& start, double proximal)
      : problem_(problem),
        kkt_(make_kkt_solver(problem.config.kkt)),
        proximal_(proximal),
        result_{SolveStatus::kIterationLimit, start, 0, 0.0, 0.0} {}

  SqpResult run(int max_iterations) {
    while (!ended()) {
      if (result_.iterations++ == max_iterations) break;
      iterate();
    }
    result_.iterations = std::min(result_.iterations, max_iterations);
    return std::move(result_);
  }

 private:
  /// Linearises at the iterate and looks for a reason to stop.
  bool ended() {
    if (failed_) return true;
    if (proximal_ <= problem_.config.exact_below) exact_ = true;
    if (proximal_ > kExactBand * problem_.config.exact_below) exact_ = false;
    lin_.emplace(problem_, result_.x, Curvature{exact_, proximal_});
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
    if (!kkt_->factorize(lin_->matrix())) return regularise(SolveStatus::kSingular);
    const BlockVector solution = kkt_->solve(lin_->right_hand_side(lin_->violation()));
    if (lin_->model_curvature(solution) <= 0.0) return regularise(SolveStatus::kLineSearchFailed);
    const double alpha = line_search(lin_->direction(solution, lin_->violation()));
    if (alpha == 0.0) return regularise(SolveStatus::kLineSearchFailed);
    if (alpha <= kShortStep) proximal_ *= kGrowth;
    if (alpha > 0.5) proximal_ = std::max(kShrinkage * proximal_, kLeastProximal);
  }

  void regularise(SolveStatus if_hopeless) {
    proximal_ *= kGrowth;
    if (proximal_ > kMostProximal) stop(if_hopeless);
  }

  /// The step length taken; 0 if none is acceptable.
  double line_search(const Direction& d) {
    const Filter::Entry now{lin_->violation().l1(), objective(problem_, result_.x)};
    const double slope = lin_->objective_slope(d);
    for (double alpha = 1.0; alpha >= kLeastStep; alpha *= 0.5) {
      const std::optional<Iterate> trial = trial_point(problem_, result_.x, d, alpha);
      if (!trial) continue;
      const Violation v = violation(problem_, *trial);
      if (accept(*trial, v, now, alpha, slope)) return alpha;
      if (alpha == 1.0 && v.l1() >= now.violation && correct(v, now, slope)) return alpha;
    }
    return 0.0;
  }

  /// Second-order correction [Wächter & Biegler 2006, 2.4]: the same system for the constraints at
  /// the full step as well.
  bool correct(const Violation& ahead, const Filter::Entry& now, double slope) {
    Violation sum = lin_->violation();
    for (std::size_t k = 0; k < sum.residuals.size(); ++k) {
      sum.residuals[k] += ahead.residuals[k];
      sum.complementarity[k] += ahead.complementarity[k];
    }
    const Direction d = lin_->direction(kkt_->solve(lin_->right_hand_side(sum)), sum);
    const std::optional<Iterate> trial = trial_point(problem_, result_.x, d, 1.0);
    return trial && accept(*trial, violation(problem_, *trial), now, 1.0, slope);
  }

  bool accept(const Iterate& trial, const Violation& v, const Filter::Entry& now, double alpha,
              double slope) {
    const Filter::Entry then{v.l1(), objective(problem_, trial)};
    if (!std::isfinite(then.violation + then.objective) || !filter_.accepts(then)) return false;
    if (then.violation > std::max(kMostViolation, now.violation)) return false;
    const bool switching = slope < 0.0 &&
                           alpha * std::pow(-slope, 2.3) > std::pow(now.violation, 1.1) &&
                           now.violation < kSmallViolation;
    const double noise = 1e-14 * (1.0 + std::abs(now.objective));
    const bool decreases = then.objective <= now.objective + kArmijo * alpha * slope + noise;
    if (switching ? !decreases : !Filter::improves(then, now)) return false;
    if (!switching) filter_.add(now);
    result_.x = trial;
    return true;
  }

  const ReverseProblem& problem_;
  std::unique_ptr<KktSolver> kkt_;
  double proximal_;
  Filter filter_;
  std::optional<Linearisation> lin_;
  bool exact_ = false, failed_ = false;
  SqpResult result_;
};

}  // namespace

SqpResult filter_sqp(const ReverseProblem& problem, const Iterate& start, int max_iterations,
                     double proximal) {
  return FilterSqp(problem, start, proximal).run(max_iterations);
}

}  // namespace rtg

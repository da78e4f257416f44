#include "core/reverse/sqp/sqp_strategy.hpp"

#include <algorithm>
#include <cmath>

namespace rtg::reverse {
namespace {

constexpr double kLeastProximal = 1e-8, kMostProximal = 1e6;
constexpr double kMaxViolation = 0.3;  // a step must not raise θ = ‖C‖₁ above this
constexpr double kShortStep = 0.2;     // δ grows after steps that are this short
constexpr int kMostPivoted = 10;       // systems per candidate that are solved again
constexpr double kGrowth = 4.0, kShrinkage = 0.1;  // factors of δ

}  // namespace

SqpStrategy::SqpStrategy(const ReverseConfig& config)
    : config_(&config), proximal_(config.proximal_start) {}

bool SqpStrategy::goes_on(const Figures& at) {
  if (!std::isfinite(at.stationarity + at.infeasibility + at.objective))
    return end(SolveStatus::kNonFinite);
  if (at.infeasibility < config_->feasibility_tol && at.stationarity < config_->stationarity_tol)
    return end(SolveStatus::kConverged);
  if (!uses_lagrangian_) return true;  // repeats the same iteration
  if (iterations_ == config_->max_iterations) {
    if (closing_) return end(SolveStatus::kIterationLimit);
    return closing_ = wants_restoration_ = true;
  }
  ++iterations_;
  return true;
}

bool SqpStrategy::may_pivot() { return ++pivoted_ <= kMostPivoted; }

bool SqpStrategy::reject_ascent() {
  if (!uses_lagrangian_) return regularise(SolveStatus::kSingular);
  uses_lagrangian_ = false;
  return true;
}

bool SqpStrategy::reject_line_search() { return regularise(SolveStatus::kLineSearchFailed); }

bool SqpStrategy::accept(const Filter::Entry& now, const Filter::Entry& next, double alpha) {
  if (!std::isfinite(next.violation + next.objective) ||
      next.violation > std::max(kMaxViolation, now.violation) || !filter_.accepts(next) ||
      !Filter::improves(next, now))
    return false;
  filter_.add(now);
  restored_ = false;
  uses_lagrangian_ = true;
  if (alpha <= kShortStep) proximal_ *= kGrowth;
  if (alpha > 0.5) proximal_ = std::max(kShrinkage * proximal_, kLeastProximal);
  return true;
}

bool SqpStrategy::end(SolveStatus status) {
  status_ = status;
  return false;
}

bool SqpStrategy::regularise(SolveStatus if_hopeless) {
  proximal_ *= kGrowth;
  uses_lagrangian_ = true;
  if (proximal_ <= kMostProximal) return true;
  if (restored_) return end(if_hopeless);
  restored_ = wants_restoration_ = true;
  filter_ = Filter{};
  pivoted_ = 0;
  proximal_ = config_->proximal_start;
  return true;
}

}  // namespace rtg::reverse

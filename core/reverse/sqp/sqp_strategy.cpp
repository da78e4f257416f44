#include "core/reverse/sqp/sqp_strategy.hpp"

#include <algorithm>
#include <cmath>

namespace rtg::reverse {
namespace {

constexpr double kLeastProximal = 1e-8, kMostProximal = 1e6;
constexpr double kMaxViolation = 0.3;  // a step must not raise θ = ‖C‖₁ above this
constexpr double kShortStep = 0.2;     // δ grows after steps that are this short
constexpr double kGrowth = 4.0, kShrinkage = 0.1;  // factors of δ
constexpr int kAttempts = 3;
constexpr double kProximalGrowth = 4.0;  // factor of the first δ, per attempt
// Most iterations before the first softening, in a soft phase, and in a stiff phase between two.
constexpr int kIterationsBeforeSoftening = 12, kSoftIterations = 6, kStiffIterations = 4;
constexpr double kSoftness = 0.2;  // weight of the soft spring, as a share of K
// An iterate is near a solution if its ‖C‖∞ and ‖∇L‖∞ are below these.
constexpr double kNearFeasible = 1e-2, kNearStationary = 1e-1;

}  // namespace

SqpStrategy::SqpStrategy(const ReverseConfig& config)
    : config_(&config), first_proximal_(config.proximal_start) {
  begin_attempt();
}

double SqpStrategy::terminal_weight() const {
  return config_->terminal_weight * (soft() ? kSoftness : 1.0);
}

SqpStrategy::Order SqpStrategy::judge(const Figures& at) {
  if (!std::isfinite(at.stationarity + at.infeasibility + at.objective))
    return end_attempt(SolveStatus::kNonFinite);
  if (phases_left_ > 0) {
    if (at.infeasibility < std::max(kNearFeasible, config_->feasibility_tol) &&
        at.stationarity < std::max(kNearStationary, config_->stationarity_tol))
      return begin_phase(phases_left_ - 1);
    const bool first = phases_left_ == 2 * config_->softenings;
    if (iterations_left_ == 0 && !first) return begin_phase(phases_left_ - 1);
    if (iterations_left_ == 0) phases_left_ = 0;
  }
  if (at.infeasibility < config_->feasibility_tol && at.stationarity < config_->stationarity_tol)
    return end_attempt(SolveStatus::kConverged);
  if (!uses_lagrangian_) return Order::kGoOn;  // repeats the same iteration
  if (iterations_ == config_->max_iterations) return end_attempt(SolveStatus::kIterationLimit);
  ++iterations_;
  if (phases_left_ > 0) --iterations_left_;
  return Order::kGoOn;
}

SqpStrategy::Order SqpStrategy::reject_ascent() {
  if (!uses_lagrangian_) return regularise(SolveStatus::kSingular);
  uses_lagrangian_ = false;
  return Order::kGoOn;
}

SqpStrategy::Order SqpStrategy::reject_line_search() {
  return regularise(SolveStatus::kLineSearchFailed);
}

bool SqpStrategy::accept(const Filter::Entry& now, const Filter::Entry& next, double alpha) {
  if (!std::isfinite(next.violation + next.objective) ||
      next.violation > std::max(kMaxViolation, now.violation) || !filter_.accepts(next) ||
      !Filter::improves(next, now))
    return false;
  filter_.add(now);
  uses_lagrangian_ = true;
  if (alpha <= kShortStep) proximal_ *= kGrowth;
  if (alpha > 0.5) proximal_ = std::max(kShrinkage * proximal_, kLeastProximal);
  return true;
}

bool SqpStrategy::replaces_result(SolveStatus ended) const {
  return ended == SolveStatus::kConverged || !missed_final_state_;
}

bool SqpStrategy::try_again(SolveStatus ended) {
  const bool missed = ended == SolveStatus::kInfeasible;
  if (ended == SolveStatus::kConverged || (missed && missed_final_state_) ||
      attempts() == kAttempts || iterations_ == config_->max_iterations)
    return false;
  // If the first attempt failed after softening, the same small δ may suffice without softening.
  if (missed || attempt_ > 0 || !softened_) first_proximal_ *= kProximalGrowth;
  missed_final_state_ = missed_final_state_ || missed;
  ++attempt_;
  begin_attempt();
  return true;
}

void SqpStrategy::begin_attempt() {
  const bool softens = attempt_ == 0 && config_->terminal_weight > 0.0;
  begin_phase(softens ? 2 * config_->softenings : 0);
  iterations_left_ = kIterationsBeforeSoftening;
}

SqpStrategy::Order SqpStrategy::begin_phase(int phases_left) {
  phases_left_ = phases_left;
  softened_ = softened_ || soft();
  iterations_left_ = soft() ? kSoftIterations : kStiffIterations;
  proximal_ = first_proximal_;
  uses_lagrangian_ = true;
  filter_ = Filter{};
  return Order::kBeginPhase;
}

SqpStrategy::Order SqpStrategy::end_attempt(SolveStatus status) {
  status_ = status;
  return Order::kEndAttempt;
}

SqpStrategy::Order SqpStrategy::regularise(SolveStatus if_hopeless) {
  proximal_ *= kGrowth;
  uses_lagrangian_ = true;
  if (proximal_ <= kMostProximal) return Order::kGoOn;
  const bool softening = phases_left_ > 0 && phases_left_ < 2 * config_->softenings;
  return softening ? begin_phase(phases_left_ - 1) : end_attempt(if_hopeless);
}

}  // namespace rtg::reverse

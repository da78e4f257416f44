#include "core/reverse/sqp/filter_sqp.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/reverse/problem/trial_point.hpp"

namespace rtg {
namespace {

constexpr double kLeastProximal = 1e-8, kMostProximal = 1e6;
constexpr double kLeastStep = 0.03;
constexpr double kMostViolation = 0.3;             // θ may not grow beyond it
constexpr double kShortStep = 0.2;                 // a step of at most this makes δ grow
constexpr double kGrowth = 4.0, kShrinkage = 0.1;  // of δ
constexpr int kAttempts = 3;
constexpr double kProximalGrowth = 4.0;  // per attempt
// Shaking: iterations before it (an iterate that has not come near a solution by then is not
// shaken), with a soft spring, and between; what is soft, in parts of K; what is near.
constexpr int kBefore = 12, kSoft = 6, kBetween = 4;
constexpr double kSoftness = 0.2;
constexpr double kNearFeasible = 1e-2, kNearStationary = 1e-1;

}  // namespace

template <class T>
FilterSqp<T>::FilterSqp(const ReverseProblem& like, std::unique_ptr<StageSolver<T>> kkt)
    : config_(like.config),
      queue_(like),
      problem_(like),
      newton_(problem_),
      kkt_(std::move(kkt)),
      evaluator_(problem_),
      x_(problem_.energy, like.sub_steps),
      trial_(x_),
      start_(x_),
      step_(problem_.energy.movable(), like.sub_steps),
      force_step_(x_.forces),
      gaps_(x_.forces),
      trial_gaps_(x_.forces),
      lane_(static_cast<std::size_t>(kWidth<T>)),
      begun_(false),
      stepping_(false) {}

template <class T>
std::vector<SqpResult> FilterSqp<T>::solve(std::span<const ReverseProblem* const> problems,
                                           std::span<const Iterate> starts) {
  problems_ = problems;
  results_.clear();
  for (const ReverseProblem* one : problems)
    results_.push_back({SolveStatus::kInfeasible, static_iterate(*one)});
  queue_.begin(problems, starts);
  while (refill()) iterate();
  return std::move(results_);
}

/// Gives lanes without a candidate the next one; false if none has one.
template <class T>
bool FilterSqp<T>::refill() {
  for (int l = 0; l < kWidth<T>; ++l) {
    if (lane_[l].job >= 0) continue;
    lane_[l] = Lane{};
    lane_[l].first_proximal = config_.proximal_start;
    lane_[l].job = queue_.take(l, start_);
    if (lane_[l].job >= 0) {
      problem_.load(l, *problems_[lane_[l].job]);
      begin_attempt(l);
    } else {
      problem_.energy.unload(l);
    }
  }
  if (any(begun_)) evaluate_begun();
  return std::ranges::any_of(lane_, [](const Lane& lane) { return lane.job >= 0; });
}

template <class T>
void FilterSqp<T>::begin_attempt(int l) {
  Lane& lane = lane_[l];
  x_.copy_lane(l, start_, l);
  begin_phase(l, lane.attempt == 0 && config_.terminal_weight > 0.0 ? 2 * config_.shakes : 0);
  lane.left = kBefore;
}

/// At the iterate; `shaking` phases follow.
template <class T>
void FilterSqp<T>::begin_phase(int l, int shaking) {
  Lane& lane = lane_[l];
  const bool soft = shaking % 2 != 0;
  lane.proximal = lane.first_proximal;
  lane.exact = true;
  lane.shaking = shaking;
  lane.shaken = lane.shaken || soft;
  lane.left = soft ? kSoft : kBetween;
  lane.filter = Filter{};
  set_lane(problem_.terminal_weight, l, config_.terminal_weight * (soft ? kSoftness : 1.0));
  set_lane(begun_, l, true);
}

template <class T>
void FilterSqp<T>::end_attempt(int l, SolveStatus status) {
  Lane& own = lane_[l];
  const ReverseProblem& problem = *problems_[own.job];
  SqpResult& result = results_[own.job];
  Iterate x = x_.unload(l, problem);
  if (status == SolveStatus::kConverged) status = judged(problem, x);
  const bool missed = status == SolveStatus::kInfeasible;
  const bool missed_before = own.attempt > 0 && result.status == SolveStatus::kInfeasible;
  if (status == SolveStatus::kConverged || !missed_before)
    result = {status, std::move(x), 0, 0, lane(now_.infeasibility, l), own.stationarity};
  result.iterations = own.iterations;
  result.attempts = own.attempt + 1;
  if (status == SolveStatus::kConverged || (missed && missed_before) ||
      result.attempts == kAttempts || own.iterations == config_.max_iterations) {
    own.job = -1;
    return;
  }
  // Where shaking led to a failure, a small δ may still do.
  if (missed || own.attempt > 0 || !own.shaken) own.first_proximal *= kProximalGrowth;
  ++own.attempt;
  begin_attempt(l);
}

/// Merits and gaps of the trajectories that attempts and phases begin with.
template <class T>
void FilterSqp<T>::evaluate_begun() {
  for (std::vector<T>& level : trial_gaps_) std::ranges::fill(level, T(0.0));
  Mask<T> legal = begun_;
  Merits<T> found = evaluator_.evaluate(problem_, x_, trial_gaps_, trial_gaps_, legal);
  found.objective = select(legal, found.objective, T(INFINITY));
  adopt(begun_, found);
  begun_ = Mask<T>(false);
}

/// Merits and trial_gaps_ are those of x from now on.
template <class T>
void FilterSqp<T>::adopt(const Mask<T>& where, const Merits<T>& found) {
  now_ = {select(where, found.objective, now_.objective),
          select(where, found.violation, now_.violation),
          select(where, found.infeasibility, now_.infeasibility)};
  for (std::size_t k = 0; k < gaps_.size(); ++k)
    for (std::size_t c = 0; c < gaps_[k].size(); ++c)
      gaps_[k][c] = select(where, trial_gaps_[k][c], gaps_[k][c]);
}

template <class T>
void FilterSqp<T>::iterate() {
  T exact(0.0), proximal(1.0);
  for (int l = 0; l < kWidth<T>; ++l) {
    set_lane(exact, l, lane_[l].exact ? 1.0 : 0.0);
    set_lane(proximal, l, lane_[l].proximal);
    busy_ += lane_[l].job >= 0 ? 1 : 0;
  }
  lanes_ += kWidth<T>;
  newton_.linearise(problem_, x_, {exact, proximal});
  const T stationarity = newton_.stationarity();
  stepping_ = Mask<T>(false);
  for (int l = 0; l < kWidth<T>; ++l)
    if (lane_[l].job >= 0) end_or_step(l, lane(stationarity, l));
  if (!any(stepping_)) return;
  const Mask<T> regular = kkt_->solve(newton_.system(), step_);
  reject_ascent(regular && newton_.model_curvature(step_) > T(0.0));
  if (!any(stepping_)) return;
  newton_.force_steps(problem_, x_, step_, force_step_);
  line_search();
}

/// Looks for a reason to stop; counts an iteration if there is none.
template <class T>
void FilterSqp<T>::end_or_step(int l, double stationarity) {
  Lane& own = lane_[l];
  own.stationarity = stationarity;
  const double infeasibility = lane(now_.infeasibility, l);
  if (!std::isfinite(stationarity + infeasibility + lane(now_.objective, l)))
    return end_attempt(l, SolveStatus::kNonFinite);
  if (own.shaking > 0 && infeasibility < std::max(kNearFeasible, config_.feasibility_tol) &&
      stationarity < std::max(kNearStationary, config_.stationarity_tol))
    return begin_phase(l, own.shaking - 1);
  if (own.shaking > 0 && own.left == 0) {
    if (own.shaking < 2 * config_.shakes) return begin_phase(l, own.shaking - 1);
    own.shaking = 0;
  }
  if (infeasibility < config_.feasibility_tol && stationarity < config_.stationarity_tol)
    return end_attempt(l, SolveStatus::kConverged);
  if (own.exact) {
    if (own.iterations == config_.max_iterations)
      return end_attempt(l, SolveStatus::kIterationLimit);
    ++own.iterations;
    if (own.shaking > 0) --own.left;
  }
  set_lane(stepping_, l, true);
}

/// Where the model is not convex along the step, the same iteration is done with the objective's
/// Hessian, and with a larger δ where that was it.
template <class T>
void FilterSqp<T>::reject_ascent(const Mask<T>& descends) {
  for (int l = 0; l < kWidth<T>; ++l) {
    if (!lane(stepping_, l) || lane(descends, l)) continue;
    set_lane(stepping_, l, false);
    if (lane_[l].exact)
      lane_[l].exact = false;
    else
      regularise(l, SolveStatus::kSingular);
  }
}

template <class T>
void FilterSqp<T>::regularise(int l, SolveStatus if_hopeless) {
  lane_[l].proximal *= kGrowth;
  lane_[l].exact = true;
  if (lane_[l].proximal <= kMostProximal) return;
  const int shaking = lane_[l].shaking;
  if (shaking > 0 && shaking < 2 * config_.shakes)
    begin_phase(l, shaking - 1);
  else
    end_attempt(l, if_hopeless);
}

template <class T>
void FilterSqp<T>::line_search() {
  Mask<T> searching = stepping_;
  for (std::size_t k = 0; k < x_.p.size(); ++k) trial_.p[k] = x_.p[k];  // bodies that do not move
  for (double alpha = 1.0; alpha >= kLeastStep && any(searching); alpha *= 0.5) {
    const T length = select(searching, T(alpha), T(0.0));
    Mask<T> legal = searching && bounded(step_, length);
    if (!any(legal)) continue;
    make_trial(problem_.energy, x_, {step_, force_step_, length}, trial_);
    const Merits<T> then = evaluator_.evaluate(problem_, trial_, gaps_, trial_gaps_, legal);
    const Mask<T> accepted = accept(legal, then, alpha);
    if (!any(accepted)) continue;
    x_.assign(accepted, trial_);
    adopt(accepted, then);
    searching = searching && !accepted;
  }
  for (int l = 0; l < kWidth<T>; ++l)
    if (lane(searching, l)) regularise(l, SolveStatus::kLineSearchFailed);
}

/// The lanes whose filter takes the trial point.
template <class T>
Mask<T> FilterSqp<T>::accept(const Mask<T>& legal, const Merits<T>& then, double alpha) {
  Mask<T> accepted(false);
  for (int l = 0; l < kWidth<T>; ++l) {
    if (!lane(legal, l)) continue;
    Lane& own = lane_[l];
    const Filter::Entry now{lane(now_.violation, l), lane(now_.objective, l)};
    const Filter::Entry next{lane(then.violation, l), lane(then.objective, l)};
    if (!std::isfinite(next.violation + next.objective) ||
        next.violation > std::max(kMostViolation, now.violation) || !own.filter.accepts(next) ||
        !Filter::improves(next, now))
      continue;
    own.filter.add(now);
    own.exact = true;
    if (alpha <= kShortStep) own.proximal *= kGrowth;
    if (alpha > 0.5) own.proximal = std::max(kShrinkage * own.proximal, kLeastProximal);
    set_lane(accepted, l, true);
  }
  return accepted;
}

template class FilterSqp<double>;
template class FilterSqp<Lanes>;

}  // namespace rtg

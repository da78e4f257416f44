#include "core/reverse/sqp/filter_sqp.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/math/kkt_solver.hpp"
#include "core/reverse/problem/trial_point.hpp"

namespace rtg::reverse {
namespace {

constexpr double kLeastStep = 0.03;

}  // namespace

template <class T>
FilterSqp<T>::FilterSqp(const ReverseProblem& like, std::unique_ptr<StageSolver<T>> kkt)
    : config_(like.config),
      queue_(like),
      problem_(like),
      newton_(problem_),
      kkt_(std::move(kkt)),
      pivoting_(problem_.fixed_end()),
      warm_(problem_),
      evaluator_(problem_),
      x_(problem_.energy, like.sub_steps),
      trial_(x_),
      step_(problem_.energy.movable(), like.sub_steps),
      force_step_(x_.forces),
      gaps_(x_.forces),
      trial_gaps_(x_.forces),
      jobs_(static_cast<std::size_t>(kWidth<T>), -1),
      beginning_(false),
      stepping_(false) {}

template <class T>
std::vector<SqpResult> FilterSqp<T>::solve(std::span<const ReverseProblem* const> problems,
                                           std::span<const Iterate> starts) {
  problems_ = problems;
  results_.clear();
  strategies_.assign(problems.size(), SqpStrategy(config_));
  for (const ReverseProblem* one : problems)
    results_.push_back({SolveStatus::kInfeasible, static_iterate(*one)});
  queue_.begin(problems, starts);
  while (refill()) iterate();
  return std::move(results_);
}

/// Gives each idle lane the next candidate of the queue. Returns whether any lane is busy then.
template <class T>
bool FilterSqp<T>::refill() {
  bool busy = false;
  for (int l = 0; l < kWidth<T>; ++l) {
    if (!is_busy(l)) {
      jobs_[l] = queue_.take(l, x_);
      set_lane(beginning_, l, is_busy(l));
      if (is_busy(l))
        problem_.load(l, *problems_[jobs_[l]]);
      else
        problem_.energy.unload(l);
    }
    busy = busy || is_busy(l);
  }
  if (!problem_.fixed_end()) restore();  // a simulation ends near the final state, not in it
  if (any(beginning_)) evaluate_beginning();
  return busy;
}

template <class T>
void FilterSqp<T>::finish(int l) {
  const int job = std::exchange(jobs_[l], -1);
  const SqpStrategy& strategy = strategies_[job];
  const ReverseProblem& problem = *problems_[job];
  Iterate x = x_.unload(l, problem);
  SolveStatus status = strategy.status();
  const SolveStatus as_converged = status_of_converged(problem, x);
  // With a fixed final state a feasible iterate says nothing: one is that in which nothing moves.
  const bool feasible =
      lane(now_.infeasibility, l) < config_.feasibility_tol && !problem_.fixed_end();
  if (status == SolveStatus::kConverged)
    status = as_converged;
  else if (feasible && status != SolveStatus::kNonFinite && as_converged == SolveStatus::kConverged)
    status = SolveStatus::kAcceptable;
  results_[job] = {status, std::move(x), strategy.iterations(), lane(now_.infeasibility, l),
                   lane(stationarity_, l)};
}

/// Replaces x_ in the lanes that ask for it by the forward simulation from its start p_0, which
/// violates no constraint. Where the simulation fails, x_ stays.
template <class T>
void FilterSqp<T>::restore() {
  Mask<T> wanted(false);
  for (int l = 0; l < kWidth<T>; ++l)
    if (is_busy(l) && strategy(l).take_restoration()) set_lane(wanted, l, true);
  if (!any(wanted)) return;
  trial_ = x_;
  const Mask<T> found = warm_.simulate(wanted, trial_);
  x_.assign(found, trial_);
  beginning_ = beginning_ || found;
}

/// Evaluates x_ in the lanes that begin, and stores the measures and gaps.
template <class T>
void FilterSqp<T>::evaluate_beginning() {
  for (std::vector<T>& level : trial_gaps_) std::ranges::fill(level, T(0.0));
  Mask<T> legal = beginning_;
  Measures<T> found = evaluator_.evaluate(problem_, x_, trial_gaps_, trial_gaps_, legal);
  found.objective = select(legal, found.objective, T(INFINITY));
  adopt(beginning_, found);
  beginning_ = Mask<T>(false);
}

/// Stores `found` and trial_gaps_ as the measures and gaps of x_ in the lanes `where`.
template <class T>
void FilterSqp<T>::adopt(const Mask<T>& where, const Measures<T>& found) {
  now_ = {select(where, found.objective, now_.objective),
          select(where, found.violation, now_.violation),
          select(where, found.infeasibility, now_.infeasibility)};
  for (std::size_t k = 0; k < gaps_.size(); ++k)
    for (std::size_t c = 0; c < gaps_[k].size(); ++c)
      gaps_[k][c] = select(where, trial_gaps_[k][c], gaps_[k][c]);
}

template <class T>
void FilterSqp<T>::iterate() {
  T lagrangian(0.0), proximal(1.0);
  for (int l = 0; l < kWidth<T>; ++l) {
    if (!is_busy(l)) continue;
    set_lane(lagrangian, l, strategy(l).uses_lagrangian() ? 1.0 : 0.0);
    set_lane(proximal, l, strategy(l).proximal());
    ++busy_;
  }
  lane_iterations_ += kWidth<T>;
  newton_.linearise(problem_, x_, {lagrangian, proximal, lagrangian});
  stationarity_ = newton_.stationarity();
  stepping_ = Mask<T>(false);
  for (int l = 0; l < kWidth<T>; ++l) {
    if (!is_busy(l)) continue;
    const bool goes_on = strategy(l).goes_on(figures(l));
    set_lane(stepping_, l, goes_on && !strategy(l).wants_restoration());
    if (!goes_on) finish(l);
  }
  if (!any(stepping_)) return;
  reject_ascent(find_step() && newton_.model_curvature(step_) > T(0.0));
  if (!any(stepping_)) return;
  newton_.force_steps(problem_, x_, step_, force_step_);
  line_search();
}

/// Solves the Newton systems. Returns the lanes of stepping_ in which they are regular. Where kkt_
/// meets a singular pivot, solves again with pivoting_, unless both are KLU.
template <class T>
Mask<T> FilterSqp<T>::find_step() {
  Mask<T> regular = kkt_->solve(newton_.system(), step_) && stepping_;
  if (config_.kkt == KktMethod::kKlu) return regular;
  for (int l = 0; l < kWidth<T>; ++l)
    if (lane(stepping_ && !regular, l) && strategy(l).may_pivot())
      set_lane(regular, l, pivoting_.solve(newton_.system(), l, step_));
  return regular;
}

template <class T>
SqpStrategy::Figures FilterSqp<T>::figures(int l) const {
  return {lane(now_.objective, l), lane(now_.infeasibility, l), lane(stationarity_, l)};
}

template <class T>
void FilterSqp<T>::reject_ascent(const Mask<T>& descends) {
  for (int l = 0; l < kWidth<T>; ++l) {
    if (!lane(stepping_, l) || lane(descends, l)) continue;
    set_lane(stepping_, l, false);
    if (!strategy(l).reject_ascent()) finish(l);
  }
}

template <class T>
void FilterSqp<T>::line_search() {
  Mask<T> searching = stepping_;
  for (std::size_t k = 0; k < x_.p.size(); ++k) trial_.p[k] = x_.p[k];  // for the fixed bodies
  for (double alpha = 1.0; alpha >= kLeastStep && any(searching); alpha *= 0.5) {
    const T length = select(searching, T(alpha), T(0.0));
    Mask<T> legal = searching && bounded(step_, length);
    if (!any(legal)) continue;
    make_trial(problem_.energy, x_, {step_, force_step_, length}, trial_);
    const Measures<T> then = evaluator_.evaluate(problem_, trial_, gaps_, trial_gaps_, legal);
    const Mask<T> accepted = accept(legal, then, alpha);
    if (!any(accepted)) continue;
    x_.assign(accepted, trial_);
    adopt(accepted, then);
    searching = searching && !accepted;
  }
  for (int l = 0; l < kWidth<T>; ++l)
    if (lane(searching, l) && !strategy(l).reject_line_search()) finish(l);
}

/// Returns the lanes of `legal` that accept the trial point with measures `then` and step length
/// `alpha`.
template <class T>
Mask<T> FilterSqp<T>::accept(const Mask<T>& legal, const Measures<T>& then, double alpha) {
  Mask<T> accepted(false);
  for (int l = 0; l < kWidth<T>; ++l)
    if (lane(legal, l))
      set_lane(accepted, l,
               strategy(l).accept({lane(now_.violation, l), lane(now_.objective, l)},
                                  {lane(then.violation, l), lane(then.objective, l)}, alpha));
  return accepted;
}

template class FilterSqp<double>;
template class FilterSqp<Lanes>;

}  // namespace rtg::reverse

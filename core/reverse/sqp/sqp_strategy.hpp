#pragma once

#include "core/reverse/problem/reverse_config.hpp"
#include "core/reverse/problem/solve_status.hpp"
#include "core/reverse/sqp/filter.hpp"

namespace rtg::reverse {

/// Controls the SQP of one candidate. It decides which Hessian and which δ the next step uses,
/// whether a trial point is accepted, and when an attempt ends. It knows only a few figures of each
/// iterate.
///
/// A solution that misses the final state counts as a failure. After a failed attempt a second one
/// may follow, from another start. If both miss the final state, the first solution is the result.
///
/// Departs from the paper: it solves once. Of the problems of real searches in tests/bench the
/// second attempt solves 26 of 2,164, and 4 of 774 with joints.
class SqpStrategy {
 public:
  /// The figures of an iterate on which decisions depend.
  struct Figures {
    double objective = 0.0;
    double infeasibility = 0.0;  // ‖C‖∞
    double stationarity = 0.0;   // ‖∇L‖∞
  };

  explicit SqpStrategy(const ReverseConfig& config);

  double proximal() const { return proximal_; }  // δ
  /// Returns whether the next step uses the Hessian of the Lagrangian. Otherwise it uses that of
  /// the objective.
  bool uses_lagrangian() const { return uses_lagrangian_; }
  int iterations() const { return iterations_; }  // over all attempts
  int attempts() const { return attempts_; }
  SolveStatus status() const { return status_; }

  /// Decides at an iterate with the figures `at` whether the attempt goes on with another step.
  /// Otherwise it has ended with status(). To be called after each linearisation. Counts an
  /// iteration, unless it repeats one with the Hessian of the objective.
  bool goes_on(const Figures& at);
  /// Returns whether to solve a Newton system again, with pivoting, in which the usual solver met a
  /// singular pivot. Counts how often it did: where it always does, no solution follows.
  bool may_pivot();
  /// Repeats the iteration with the Hessian of the objective or, if that was used already, with a
  /// larger δ. To be called if the system is singular or the model is not convex along the step.
  /// Returns false if the attempt has ended.
  bool reject_ascent();
  /// Repeats the iteration with a larger δ, which counts as another one. To be called if the line
  /// search accepts no trial point. Returns false if the attempt has ended.
  bool reject_line_search();
  /// Returns whether to accept the trial point `next`, reached from `now` with step length `alpha`.
  /// If so, updates the filter and δ.
  bool accept(const Filter::Entry& now, const Filter::Entry& next, double alpha);

  /// Returns whether the result of an attempt with status `ended` replaces that of an earlier one.
  bool replaces_result(SolveStatus ended) const;
  /// Returns whether another attempt is worth while after one with status `ended`.
  bool wants_another(SolveStatus ended) const;
  /// Begins the second attempt after one with status `ended`.
  void begin_second(SolveStatus ended);

 private:
  bool end_attempt(SolveStatus status);
  bool regularise(SolveStatus if_hopeless);

  const ReverseConfig* config_;
  int attempts_ = 1, iterations_ = 0, pivoted_ = 0;
  double proximal_;  // δ
  bool uses_lagrangian_ = true;
  bool missed_final_state_ = false;  // whether the first attempt missed the final state
  SolveStatus status_ = SolveStatus::kNonFinite;
  Filter filter_;
};

}  // namespace rtg::reverse

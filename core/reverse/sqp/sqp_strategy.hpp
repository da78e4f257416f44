#pragma once

#include "core/reverse/problem/reverse_config.hpp"
#include "core/reverse/problem/solve_status.hpp"
#include "core/reverse/sqp/filter.hpp"

namespace rtg::reverse {

/// Controls the SQP of one candidate. It decides which Hessian and which δ the next step uses,
/// whether a trial point is accepted, and when an attempt ends. It also decides whether another
/// attempt from the same start follows. It knows only a few figures of each iterate.
///
/// A solution that misses the final state counts as a failure. After a failed attempt another one
/// begins, up to three in all, each with a larger first δ. After a second solution that misses the
/// final state, no attempt follows. The first such solution is the result, unless a later attempt
/// converges.
///
/// Departs from the paper: it solves once. Of the problems of real searches in tests/bench the
/// further attempts solve 29 of 2,164 more, and 13 of 774 with joints.
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
  int attempts() const { return attempt_ + 1; }
  SolveStatus status() const { return status_; }

  /// Decides at an iterate with the figures `at` whether the attempt goes on with another step.
  /// Otherwise it has ended with status(). To be called after each linearisation. Counts an
  /// iteration, unless it repeats one with the Hessian of the objective.
  bool goes_on(const Figures& at);
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

  /// Returns whether the result of an attempt with status `ended` replaces those of earlier
  /// attempts.
  bool replaces_result(SolveStatus ended) const;
  /// Begins another attempt after one with status `ended`. Returns false if no further attempt
  /// follows.
  bool try_again(SolveStatus ended);

 private:
  void begin_attempt();
  bool end_attempt(SolveStatus status);
  bool regularise(SolveStatus if_hopeless);

  const ReverseConfig* config_;
  int attempt_ = 0, iterations_ = 0;
  double proximal_ = 1.0, first_proximal_;  // δ; δ of an attempt's first iteration
  bool uses_lagrangian_ = true;
  bool missed_final_state_ = false;  // whether an earlier attempt missed the final state
  SolveStatus status_ = SolveStatus::kNonFinite;
  Filter filter_;
};

}  // namespace rtg::reverse

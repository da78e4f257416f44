#pragma once

#include "core/reverse/problem/reverse_config.hpp"
#include "core/reverse/problem/solve_status.hpp"
#include "core/reverse/sqp/filter.hpp"

namespace rtg::reverse {

/// Controls the SQP of one candidate. It decides which Hessian and which δ the next step uses,
/// whether a trial point is accepted, and when a phase ends. It also decides whether another
/// attempt from the same start follows. It knows only a few figures of each iterate.
///
/// In the first attempt, phases with a soft spring K to the final state alternate with stiff
/// phases. There are ReverseConfig::softenings soft phases, with a stiff phase before and after
/// each.
///
///   - The first phase ends when the iterate is near a solution. If it is not after a few
///     iterations, the attempt goes on without soft phases.
///   - Each phase between the first and the last ends when the iterate is near a solution, or after
///     a few iterations.
///
/// Softening mostly leads out of poor minima, in which the push loses an object that it could drag
/// along. Now and then it leads into one.
///
/// A solution that misses the final state counts as a failure. After a failed attempt another one
/// begins, up to three in all, without softening and mostly with a larger first δ. After a second
/// solution that misses the final state, no attempt follows. The first such solution is the result,
/// unless a later attempt converges.
class SqpStrategy {
 public:
  enum class Order {
    kGoOn,        // compute the next step
    kBeginPhase,  // at the same iterate, with another terminal_weight()
    kEndAttempt,  // with status()
  };

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
  /// Returns the present weight of the spring to the final state: K, or less in a soft phase.
  double terminal_weight() const;
  int iterations() const { return iterations_; }  // over all attempts
  int attempts() const { return attempt_ + 1; }
  SolveStatus status() const { return status_; }

  /// Decides how to continue at an iterate with the figures `at`. To be called after each
  /// linearisation. If the order is kGoOn, counts an iteration, unless it repeats one with the
  /// Hessian of the objective.
  Order judge(const Figures& at);
  /// Repeats the iteration with the Hessian of the objective or, if that was used already, with a
  /// larger δ. To be called if the system is singular or the model is not convex along the step.
  Order reject_ascent();
  /// Repeats the iteration with a larger δ, which counts as another one. To be called if the line
  /// search accepts no trial point.
  Order reject_line_search();
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
  Order begin_phase(int phases_left);
  Order end_attempt(SolveStatus status);
  Order regularise(SolveStatus if_hopeless);
  bool soft() const { return phases_left_ % 2 != 0; }

  const ReverseConfig* config_;
  int attempt_ = 0, iterations_ = 0;
  double proximal_ = 1.0, first_proximal_;  // δ; δ of a phase's first iteration
  bool uses_lagrangian_ = true;
  int phases_left_ = 0;              // phases to come in this attempt; odd: the spring is soft
  int iterations_left_ = 0;          // in this phase, if others follow
  bool softened_ = false;            // whether any attempt has had a soft phase
  bool missed_final_state_ = false;  // whether an earlier attempt missed the final state
  SolveStatus status_ = SolveStatus::kNonFinite;
  Filter filter_;
};

}  // namespace rtg::reverse

#pragma once

#include "core/reverse/problem/reverse_config.hpp"
#include "core/reverse/problem/solve_status.hpp"
#include "core/reverse/sqp/filter.hpp"

namespace rtg::reverse {

/// The control flow of one candidate's SQP. From the figures of the iterates alone it decides which
/// Hessian and which δ the next step uses, whether a trial point is accepted, and how phases and
/// attempts follow each other. It depends neither on lanes nor on trajectories.
///
/// The first attempt softens the spring K to the final state ReverseConfig::softenings times, for a
/// few iterations each. The first softening begins when the iterate is near a solution; if it is
/// not after a few iterations, the attempt continues without softening. Each later softening begins
/// when the iterate is near a solution again, or after a few iterations in any case. Softening
/// mostly leads out of poor minima, in which the push loses an object that it could drag along; now
/// and then it leads into one.
///
/// An attempt that fails or misses the final state is followed by another, up to three in all,
/// without softening and mostly with a larger first δ. A solution that misses the final state is
/// replaced only by a converged one. After a second solution that misses it, no attempt follows.
class SqpStrategy {
 public:
  enum class Order {
    kGoOn,        // compute the next step
    kBeginPhase,  // at the same iterate, with another terminal_weight()
    kEndAttempt,  // with status()
  };

  /// Figures of an iterate on which the decisions depend.
  struct Figures {
    double objective = 0.0;
    double infeasibility = 0.0;  // ‖C‖∞
    double stationarity = 0.0;   // ‖∇L‖∞
  };

  explicit SqpStrategy(const ReverseConfig& config);

  double proximal() const { return proximal_; }  // δ
  /// Returns whether the next step uses the Hessian of the Lagrangian; otherwise it uses that of
  /// the objective.
  bool exact() const { return exact_; }
  /// Returns the present weight of the spring to the final state: K, or less in a soft phase.
  double terminal_weight() const;
  int iterations() const { return iterations_; }  // over all attempts
  int attempts() const { return attempt_ + 1; }
  SolveStatus status() const { return status_; }

  /// Decides how to continue at a linearised iterate; to be called at each of them. Counts an
  /// iteration if it orders a step, unless that step repeats an iteration (reject_ascent()).
  Order judge(const Figures& at);
  /// To be called if the system is singular or the model is not convex along the step. The
  /// iteration is repeated with the Hessian of the objective, or, if it was made with that Hessian
  /// already, with a larger δ.
  Order reject_ascent();
  /// To be called if no trial point was accepted: δ grows.
  Order reject_line_search();
  /// Decides whether to accept the trial point `next`, reached from `now` with step length `alpha`.
  /// If so, updates the filter and δ.
  bool accept(const Filter::Entry& now, const Filter::Entry& next, double alpha);

  /// Returns whether the solution of the attempt that ended with status `ended` replaces those of
  /// earlier attempts.
  bool replaces_result(SolveStatus ended) const;
  /// Begins another attempt after one that ended with status `ended`. Returns false if no further
  /// attempt follows.
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
  bool exact_ = true;
  int phases_left_ = 0;              // of this attempt; odd: the spring is soft
  int iterations_left_ = 0;          // of this phase, if others follow
  bool softened_ = false;            // whether any attempt has had a soft phase
  bool missed_final_state_ = false;  // whether an earlier attempt missed the final state
  SolveStatus status_ = SolveStatus::kNonFinite;
  Filter filter_;
};

}  // namespace rtg::reverse

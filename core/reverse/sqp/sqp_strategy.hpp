#pragma once

#include "core/reverse/problem/reverse_config.hpp"
#include "core/reverse/problem/solve_status.hpp"
#include "core/reverse/sqp/filter.hpp"

namespace rtg::reverse {

/// The control flow of one candidate's SQP: decides from the figures of its iterates alone with
/// which Hessian and which δ the next step is made, whether a trial point is taken, and how phases
/// and attempts follow each other. It knows neither lanes nor trajectories.
///
/// The first attempt softens the spring K to the final state ReverseConfig::softenings times for a
/// few iterations, once its iterate has come near a solution or after a few iterations in any case.
/// That mostly leads out of poor minima, in which an object is let go of that could be dragged
/// along, now and then into one. An attempt that fails, or misses the final state, is followed by
/// others, up to three in all, without softening and mostly with a larger first δ. Of two solutions
/// that miss the final state the first is kept, and that is the end.
class SqpStrategy {
 public:
  enum class Order {
    kGoOn,        // to the next step
    kBeginPhase,  // at the same iterate, with another terminal_weight()
    kEndAttempt,  // with status()
  };

  /// What is known of an iterate.
  struct Figures {
    double objective = 0.0;
    double infeasibility = 0.0;  // ‖C‖∞
    double stationarity = 0.0;   // ‖∇L‖∞
  };

  explicit SqpStrategy(const ReverseConfig& config);

  double proximal() const { return proximal_; }  // δ
  /// Says whether the next step is made with the Lagrangian's Hessian, or else the objective's.
  bool exact() const { return exact_; }
  /// The weight K of the spring to the final state, softened or not.
  double terminal_weight() const;
  int iterations() const { return iterations_; }  // in all attempts
  int attempts() const { return attempt_ + 1; }
  SolveStatus status() const { return status_; }

  /// To be asked at each linearised iterate. Counts an iteration if it orders a step.
  Order judge(const Figures& at);
  /// Where the model is not convex along the step, the same iteration is done with the objective's
  /// Hessian, and with a larger δ where that was it.
  Order reject_ascent();
  /// No trial point was taken: δ grows.
  Order reject_line_search();
  /// Decides on the trial point `next` that lies `alpha` of a step from `now`.
  bool accept(const Filter::Entry& now, const Filter::Entry& next, double alpha);

  /// Says whether the attempt that ended so is the one whose solution counts.
  bool counts(SolveStatus ended) const;
  /// Begins another attempt after one that ended so; false if there is none.
  bool try_again(SolveStatus ended);

 private:
  void begin_attempt();
  Order begin_phase(int phases_left);
  Order end_attempt(SolveStatus status);
  Order regularise(SolveStatus if_hopeless);
  bool soft() const { return phases_left_ % 2 != 0; }

  const ReverseConfig* config_;
  int attempt_ = 0, iterations_ = 0;
  double proximal_ = 1.0, first_proximal_;  // of a phase's first iteration
  bool exact_ = true;
  int phases_left_ = 0;      // of this attempt; odd: the spring is soft
  int iterations_left_ = 0;  // of this phase, where others are to follow
  bool softened_ = false;    // in any attempt
  bool missed_ = false;      // the final state, in an attempt before
  SolveStatus status_ = SolveStatus::kNonFinite;
  Filter filter_;
};

}  // namespace rtg::reverse

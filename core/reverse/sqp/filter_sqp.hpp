#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/reverse/problem/evaluator.hpp"
#include "core/reverse/problem/newton_system.hpp"
#include "core/reverse/sqp/sqp_result.hpp"
#include "core/reverse/sqp/sqp_strategy.hpp"
#include "core/reverse/sqp/start_queue.hpp"

namespace rtg::reverse {

/// The SQP of the preset `default`: exact Hessian with the objective's in its place where the model
/// is not convex along the step, proximal term δ, filter line search. Each lane of T works on a
/// candidate and takes the next one when that has ended; SqpStrategy says how each goes on.
template <class T>
class FilterSqp {
 public:
  /// For problems with the numbers of bodies, the joints and the configurations of `like`.
  FilterSqp(const ReverseProblem& like, std::unique_ptr<StageSolver<T>> kkt);

  /// From the given starts, one per problem (kNonFinite where one is not legal, its barrier being
  /// infinite); from warm starts if there are none (kInfeasible where bodies overlap in the final
  /// state).
  std::vector<SqpResult> solve(std::span<const ReverseProblem* const> problems,
                               std::span<const Iterate> starts = {});

  /// Share of the lanes at work, over all iterations so far.
  double occupancy() const { return static_cast<double>(busy_) / static_cast<double>(lanes_); }

 private:
  struct Lane {
    int job;  // -1: none
    SqpStrategy strategy;
  };

  bool refill();
  void begin_attempt(int l);
  void begin_phase(int l);
  bool obey(int l, SqpStrategy::Order order);
  void end_attempt(int l);
  void evaluate_begun();
  void adopt(const Mask<T>& where, const Measures<T>& found);
  void iterate();
  SqpStrategy::Figures figures(int l) const;
  void reject_ascent(const Mask<T>& descends);
  void line_search();
  Mask<T> accept(const Mask<T>& legal, const Measures<T>& then, double alpha);

  const ReverseConfig& config_;
  std::span<const ReverseProblem* const> problems_;
  std::vector<SqpResult> results_;
  StartQueue<T> queue_;
  ProblemLanes<T> problem_;
  NewtonSystem<T> newton_;
  std::unique_ptr<StageSolver<T>> kkt_;
  Evaluator<T> evaluator_;
  Trajectory<T> x_, trial_, start_;
  StageStep<T> step_;
  PerContact<T> force_step_, gaps_, trial_gaps_;
  Measures<T> now_;  // of x
  T stationarity_;   // ‖∇L‖∞ of x
  std::vector<Lane> lane_;
  Mask<T> begun_, stepping_;  // at the start of a phase; with a step to take
  long busy_ = 0, lanes_ = 0;
};

}  // namespace rtg::reverse

#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/math/pivoting_solver.hpp"
#include "core/reverse/problem/evaluator.hpp"
#include "core/reverse/problem/newton_system.hpp"
#include "core/reverse/sqp/sqp_result.hpp"
#include "core/reverse/sqp/sqp_strategy.hpp"
#include "core/reverse/sqp/start_queue.hpp"

namespace rtg::reverse {

/// The SQP of the preset `default`, with the Hessian of the Lagrangian, a proximal term δ and a
/// filter line search. Where the model is not convex along the step, it uses the Hessian of the
/// objective instead. Each SIMD lane of T solves one candidate and then takes the next one from a
/// queue. An SqpStrategy per candidate controls the iterations.
///
/// Departs from the paper: its SQP has the Hessian of the objective, eq. (9), and an l1 merit
/// function, A.2. In a prototype, not in this code, these converged in 3 to 4 of ten scenes of
/// three objects within 300 iterations, with a filter instead of the merit function in 6, with the
/// Hessian of the Lagrangian as well in 9. `MeritSqp` is the printed one; docs/paper_mode.md says
/// what it does in this code.
template <class T>
class FilterSqp {
 public:
  /// The problems must be such as ProblemLanes(like) can load. `kkt` solves the Newton systems by
  /// the method `like.config.kkt`.
  FilterSqp(const ReverseProblem& like, std::unique_ptr<StageSolver<T>> kkt);

  /// Solves `problems` from `starts`, one per problem. If `starts` is empty, computes warm starts.
  /// The status is kNonFinite if bodies overlap anywhere in a given start, as its objective is
  /// infinite. With warm starts, the status is kInfeasible if bodies overlap in the final state.
  std::vector<SqpResult> solve(std::span<const ReverseProblem* const> problems,
                               std::span<const Iterate> starts = {});

  /// Returns the share of busy lanes, averaged over all iterations so far.
  double occupancy() const {
    return static_cast<double>(busy_) / static_cast<double>(lane_iterations_);
  }

 private:
  bool refill();
  Mask<T> find_step();
  bool is_busy(int l) const { return jobs_[l] >= 0; }
  SqpStrategy& strategy(int l) { return strategies_[static_cast<std::size_t>(jobs_[l])]; }
  void finish(int l);
  void evaluate_beginning();
  void adopt(const Mask<T>& where, const Measures<T>& found);
  void iterate();
  SqpStrategy::Figures figures(int l) const;
  void reject_ascent(const Mask<T>& descends);
  void line_search();
  void restore();
  Mask<T> accept(const Mask<T>& legal, const Measures<T>& then, double alpha);

  const ReverseConfig& config_;
  std::span<const ReverseProblem* const> problems_;
  std::vector<SqpResult> results_;
  std::vector<SqpStrategy> strategies_;  // by candidate
  StartQueue<T> queue_;
  ProblemLanes<T> problem_;
  NewtonSystem<T> newton_;
  std::unique_ptr<StageSolver<T>> kkt_;
  PivotingSolver<T> pivoting_;  // where kkt_ reports a singular system
  WarmStart<T> warm_;           // restores feasibility
  Evaluator<T> evaluator_;
  Trajectory<T> x_, trial_;
  StageStep<T> step_;
  PerContact<T> force_step_, gaps_, trial_gaps_;
  Measures<T> now_;               // of x_
  T stationarity_;                // ‖∇L‖∞ of x_
  std::vector<int> jobs_;         // candidates by lane; -1: none
  Mask<T> beginning_, stepping_;  // lanes that begin; lanes that take a step
  long busy_ = 0, lane_iterations_ = 0;
};

}  // namespace rtg::reverse

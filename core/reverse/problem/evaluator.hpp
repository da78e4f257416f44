#pragma once

#include "core/reverse/problem/problem_lanes.hpp"

namespace rtg::reverse {

/// Objective and constraint violation of a trajectory, by which line searches judge it.
template <class T>
struct Measures {
  T objective = T(0.0);
  T violation = T(0.0);      // ‖C‖₁
  T infeasibility = T(0.0);  // ‖C‖∞
};

/// Evaluates objective, constraints and legality of trajectories. Level k of a trajectory is its
/// state after sub-step k, level 0 the start.
template <class T>
class Evaluator {
 public:
  /// If `all_levels`, evaluate() always computes all levels. Otherwise it stops when no lane is
  /// legal any more.
  explicit Evaluator(const ProblemLanes<T>& problem, bool all_levels = false);

  /// Evaluates the trial point `x` and writes its gaps to `gaps`. `previous_gaps` holds the gaps of
  /// the iterate from which `x` was made. The lanes to evaluate are passed in `legal`. On return,
  /// `legal` marks those of them in which
  ///
  ///   - is_gap_acceptable() accepts every gap: it is positive and has not shrunk too much,
  ///   - no two bodies overlap by the separating-axis test.
  ///
  /// In all other lanes the results may be wrong.
  Measures<T> evaluate(const ProblemLanes<T>& problem, const Trajectory<T>& x,
                       const PerContact<T>& previous_gaps, PerContact<T>& gaps, Mask<T>& legal);

  /// Returns Φ_k of the last trajectory [h + 1][dofs]; entry 0 is unused.
  const std::vector<std::vector<T>>& residuals() const { return residuals_; }
  /// Returns λ g - μ̃ w of the last trajectory [h + 1][contacts].
  const PerContact<T>& complementarity() const { return complementarity_; }

 private:
  struct Pass;

  bool all_levels_;
  std::vector<std::vector<T>> residuals_;
  PerContact<T> complementarity_;
  std::vector<T> at_joints_;  // forces of the limits at a level, one per joint
};

}  // namespace rtg::reverse

#pragma once

#include "core/reverse/problem/problem_lanes.hpp"

namespace rtg::reverse {

/// The figures by which line searches judge trajectories.
template <class T>
struct Measures {
  T objective = T(0.0);
  T violation = T(0.0);      // ‖C‖₁
  T infeasibility = T(0.0);  // ‖C‖∞
};

/// Evaluates objective, constraints and legality of trajectories.
template <class T>
class Evaluator {
 public:
  /// `to_the_end`: evaluate() goes through all levels, even if no lane is legal any more.
  explicit Evaluator(const ProblemLanes<T>& problem, bool to_the_end = false);

  /// Evaluates the trial point x and writes its gaps to `gaps`; `were` holds the gaps of the
  /// iterate that it was made from. On entry, `legal` marks the lanes to evaluate; on return, those
  /// in which x is a legal iterate. There every gap is open, every gap below a tenth of the
  /// barrier's range is at least a tenth of its value in `were`, and no two bodies overlap by the
  /// separating-axis test. In other lanes all results may be wrong.
  Measures<T> evaluate(const ProblemLanes<T>& problem, const Trajectory<T>& x,
                       const PerContact<T>& were, PerContact<T>& gaps, Mask<T>& legal);

  /// Return the residuals of the last trajectory: Φ_k [h + 1][dofs], entry 0 unused, and λ g - μ̃ w
  /// [h + 1][contacts].
  const std::vector<std::vector<T>>& residuals() const { return residuals_; }
  const PerContact<T>& complementarity() const { return complementarity_; }

 private:
  struct Pass;

  bool to_the_end_;
  std::vector<std::vector<T>> residuals_;
  PerContact<T> complementarity_;
};

}  // namespace rtg::reverse

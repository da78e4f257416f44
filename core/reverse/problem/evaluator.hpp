#pragma once

#include "core/reverse/problem/problem_lanes.hpp"

namespace rtg::reverse {

/// The figures that line searches look at.
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
  /// `to_the_end`: also where no lane is legal any more.
  explicit Evaluator(const ProblemLanes<T>& problem, bool to_the_end = false);

  /// A trial point of an iterate whose gaps `were`; their own in `gaps`. `legal`, where x is to be
  /// looked at, comes back as where it is a legal iterate: every gap open and, below a tenth of the
  /// barrier's range, at least a tenth of itself, no two bodies overlapping by the separating-axis
  /// test. Where it is not, the rest may be wrong.
  Measures<T> evaluate(const ProblemLanes<T>& problem, const Trajectory<T>& x,
                       const PerContact<T>& were, PerContact<T>& gaps, Mask<T>& legal);

  /// Residuals Φ_k [h + 1][dofs] of the last trajectory, entry 0 unused, and λ g - μ̃ w.
  const std::vector<std::vector<T>>& residuals() const { return residuals_; }
  const PerContact<T>& complementarity() const { return complementarity_; }

 private:
  struct Pass;

  bool to_the_end_;
  std::vector<std::vector<T>> residuals_;
  PerContact<T> complementarity_;
};

}  // namespace rtg::reverse

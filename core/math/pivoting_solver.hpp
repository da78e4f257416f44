#pragma once

#include "core/math/assembled_solver.hpp"

namespace rtg {

/// Solves the StageSystem of a single lane with SuiteSparse's KLU, which chooses its pivots and,
/// unlike UMFPACK, calls no BLAS, whose roundings depend on the machine.
/// For systems in which another solver meets a singular pivot block: Riccati needs a regular E_k,
/// the derivative of each sub-step's residual, and the whole system may be regular without.
template <class T>
class PivotingSolver {
 public:
  explicit PivotingSolver(bool fixed_end) : klu_(KktMethod::kKlu, fixed_end) {}

  /// Writes the solution of lane l of `system` to lane l of `step`. Returns false, and leaves
  /// `step` as it is, if the system is singular.
  bool solve(const StageSystem<T>& system, int l, StageStep<T>& step);

 private:
  AssembledSolver klu_;
};

}  // namespace rtg

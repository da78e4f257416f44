#pragma once

#include "core/math/assembled_solver.hpp"

namespace rtg {

/// Solves the StageSystem of a single lane with SuiteSparse's UMFPACK, which chooses its pivots.
/// For systems in which another solver meets a singular pivot block: Riccati needs a regular E_k,
/// the derivative of each sub-step's residual, and the whole system may be regular without.
template <class T>
class PivotingSolver {
 public:
  explicit PivotingSolver(bool fixed_end) : umfpack_(KktMethod::kUmfpack, fixed_end) {}

  /// Writes the solution of lane l of `system` to lane l of `step`. Returns false, and leaves
  /// `step` as it is, if the system is singular.
  bool solve(const StageSystem<T>& system, int l, StageStep<T>& step);

 private:
  AssembledSolver umfpack_;
};

}  // namespace rtg

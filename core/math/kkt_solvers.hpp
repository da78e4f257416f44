#pragma once

#include <Eigen/LU>
#include <vector>

#include "core/math/kkt_solver.hpp"

namespace rtg {

/// LU factorisation of a pivot block. factorize() returns false if the block is not finite or
/// singular: its largest pivot is at least 1e14 times the least.
class PivotBlock {
 public:
  [[nodiscard]] bool factorize(const MatrixXd& A);
  template <class Rhs>
  auto solve(const Rhs& r) const {
    return lu_.solve(r);
  }

 private:
  Eigen::PartialPivLU<MatrixXd> lu_;
};

/// Block elimination from the last block to the first; see make_kkt_solver().
class BlockElimination final : public KktSolver {
 public:
  [[nodiscard]] bool factorize(const BlockTridiagonal& K) override;
  [[nodiscard]] BlockVector solve(const BlockVector& r) const override;

 private:
  std::vector<PivotBlock> pivots_;
  std::vector<MatrixXd> B_, gain_;  // gain_[k] = pivot_k⁻¹ B_k
};

/// Cyclic reduction [Hockney 1965]; see make_kkt_solver().
class CyclicReduction final : public KktSolver {
 public:
  [[nodiscard]] bool factorize(const BlockTridiagonal& K) override;
  [[nodiscard]] BlockVector solve(const BlockVector& r) const override;

 private:
  /// A reduction step. It eliminates the odd blocks of the system and keeps the even ones.
  struct Level {
    std::size_t blocks = 0;
    std::vector<PivotBlock> pivots;     // of the odd blocks
    std::vector<MatrixXd> B;            // of this level's system
    std::vector<MatrixXd> left, right;  // pivot⁻¹ times the couplings to the even neighbours
  };
  [[nodiscard]] bool halve(BlockTridiagonal& K);

  std::vector<Level> levels_;
  PivotBlock last_;
};

}  // namespace rtg

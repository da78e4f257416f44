#pragma once

#include <Eigen/LU>
#include <vector>

#include "core/math/kkt_solver.hpp"

namespace rtg {

/// Least ratio of two pivots of a matrix that counts as regular.
inline constexpr double kLeastPivotRatio = 1e-14;

/// LU factorisation of a pivot block. factorize() returns false if the block is not finite or
/// singular.
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

/// Cyclic reduction [Hockney 1965]; see make_kkt_solver(). Each reduction eliminates its blocks
/// without exchanging rows between them, so that roundings may grow. solve() then corrects x by one
/// step of iterative refinement: on systems with inertia this brings residuals of 1e-7 to 1e-16.
class CyclicReduction final : public KktSolver {
 public:
  [[nodiscard]] bool factorize(const BlockTridiagonal& K) override;
  [[nodiscard]] BlockVector solve(const BlockVector& r) const override;

 private:
  /// A system of which a reduction eliminates the odd blocks and keeps the even ones, the next
  /// level's. Its memory serves one factorisation after the other.
  struct Level {
    BlockTridiagonal K;
    std::vector<PivotBlock> pivots;     // of the odd blocks
    std::vector<MatrixXd> left, right;  // pivot⁻¹ times the couplings to the even neighbours
  };
  [[nodiscard]] static bool halve(Level& level, BlockTridiagonal& half);
  [[nodiscard]] BlockVector reduced_solution(const BlockVector& r) const;

  std::vector<Level> levels_;  // the last one has a single block
  PivotBlock last_;
};

}  // namespace rtg

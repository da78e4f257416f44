#include <algorithm>

#include "core/math/kkt_solvers.hpp"

namespace rtg {
namespace {

// Solutions with a smaller residual / (|r| + |x|) are not refined.
constexpr double kAccurate = 1e-12;

double largest(const BlockVector& x) {
  double most = 0.0;
  for (const VectorXd& block : x) most = std::max(most, block.lpNorm<Eigen::Infinity>());
  return most;
}

}  // namespace

/// Reduces K to the system of its blocks 0, 2, ... Returns false if a pivot block is singular. The
/// other blocks are eliminated by
///   x_j = P_j⁻¹ (r_j - B_j x_{j-1} - B_{j+1}ᵀ x_{j+1}),  j odd.
bool CyclicReduction::halve(BlockTridiagonal& K) {
  Level level;
  level.blocks = K.blocks();
  level.B = K.B;
  BlockTridiagonal half;
  for (std::size_t k = 0; k < K.blocks(); k += 2) {
    half.A.push_back(K.A[k]);
    half.B.push_back(MatrixXd());
  }
  for (std::size_t j = 1; j < K.blocks(); j += 2) {
    PivotBlock pivot;
    if (!pivot.factorize(K.A[j])) return false;
    level.left.push_back(pivot.solve(K.B[j]));
    half.A[j / 2].noalias() -= K.B[j].transpose() * level.left.back();
    if (j + 1 < K.blocks()) {
      level.right.push_back(pivot.solve(K.B[j + 1].transpose()));
      half.A[j / 2 + 1].noalias() -= K.B[j + 1] * level.right.back();
      half.B[j / 2 + 1].noalias() = -K.B[j + 1] * level.left.back();
    }
    level.pivots.push_back(std::move(pivot));
  }
  levels_.push_back(std::move(level));
  K = std::move(half);
  return true;
}

bool CyclicReduction::factorize(const BlockTridiagonal& K) {
  levels_.clear();
  K_ = K;
  BlockTridiagonal rest = K;
  while (rest.blocks() > 1)
    if (!halve(rest)) return false;
  return last_.factorize(rest.A[0]);
}

BlockVector CyclicReduction::solve(const BlockVector& r) const {
  BlockVector x = reduced_solution(r);
  BlockVector residual = product(K_, x);
  for (std::size_t k = 0; k < r.size(); ++k) residual[k] = r[k] - residual[k];
  if (largest(residual) <= kAccurate * (largest(r) + largest(x))) return x;
  const BlockVector correction = reduced_solution(residual);
  for (std::size_t k = 0; k < r.size(); ++k) x[k] += correction[k];
  return x;
}

/// Carries `r` down the levels and the solution back up.
BlockVector CyclicReduction::reduced_solution(const BlockVector& r) const {
  std::vector<BlockVector> rhs{r};
  for (const Level& level : levels_) {
    const BlockVector& fine = rhs.back();
    BlockVector half;
    for (std::size_t k = 0; k < level.blocks; k += 2) half.push_back(fine[k]);
    for (std::size_t j = 1; j < level.blocks; j += 2) {
      half[j / 2].noalias() -= level.left[j / 2].transpose() * fine[j];
      if (j + 1 < level.blocks)
        half[j / 2 + 1].noalias() -= level.right[j / 2].transpose() * fine[j];
    }
    rhs.push_back(std::move(half));
  }
  BlockVector x{last_.solve(rhs.back()[0])};
  for (std::size_t l = levels_.size(); l-- > 0;) {
    const Level& level = levels_[l];
    BlockVector fine(level.blocks);
    for (std::size_t k = 0; k < level.blocks; k += 2) fine[k] = x[k / 2];
    for (std::size_t j = 1; j < level.blocks; j += 2) {
      fine[j] = level.pivots[j / 2].solve(rhs[l][j]) - level.left[j / 2] * fine[j - 1];
      if (j + 1 < level.blocks) fine[j].noalias() -= level.right[j / 2] * fine[j + 1];
    }
    x = std::move(fine);
  }
  return x;
}

}  // namespace rtg

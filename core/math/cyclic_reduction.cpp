#include <algorithm>
#include <bit>

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

/// Writes the system of the even blocks of level.K to `half`. Returns false if a pivot block is
/// singular. The odd blocks are eliminated by
///   x_j = P_j⁻¹ (r_j - B_j x_{j-1} - B_{j+1}ᵀ x_{j+1}).
bool CyclicReduction::halve(Level& level, BlockTridiagonal& half) {
  const BlockTridiagonal& K = level.K;
  const std::size_t N = K.blocks();
  half.A.resize((N + 1) / 2);
  half.B.resize(half.A.size());
  level.pivots.resize(N / 2);
  level.left.resize(N / 2);
  level.right.resize((N - 1) / 2);
  for (std::size_t k = 0; k < N; k += 2) half.A[k / 2] = K.A[k];
  for (std::size_t j = 1; j < N; j += 2) {
    const std::size_t before = j / 2, after = before + 1;
    if (!level.pivots[before].factorize(K.A[j])) return false;
    level.left[before] = level.pivots[before].solve(K.B[j]);
    half.A[before].noalias() -= K.B[j].transpose() * level.left[before];
    if (j + 1 == N) break;
    level.right[before] = level.pivots[before].solve(K.B[j + 1].transpose());
    half.A[after].noalias() -= K.B[j + 1] * level.right[before];
    half.B[after].noalias() = -K.B[j + 1] * level.left[before];
  }
  return true;
}

bool CyclicReduction::factorize(const BlockTridiagonal& K) {
  levels_.resize(1 + static_cast<std::size_t>(std::bit_width(K.blocks() - 1)));
  levels_[0].K = K;
  for (std::size_t l = 0; l + 1 < levels_.size(); ++l)
    if (!halve(levels_[l], levels_[l + 1].K)) return false;
  return last_.factorize(levels_.back().K.A[0]);
}

BlockVector CyclicReduction::solve(const BlockVector& r) const {
  BlockVector x = reduced_solution(r);
  BlockVector residual = product(levels_[0].K, x);
  for (std::size_t k = 0; k < r.size(); ++k) residual[k] = r[k] - residual[k];
  if (largest(residual) <= kAccurate * (largest(r) + largest(x))) return x;
  const BlockVector correction = reduced_solution(residual);
  for (std::size_t k = 0; k < r.size(); ++k) x[k] += correction[k];
  return x;
}

/// Carries `r` down the levels and the solution back up.
BlockVector CyclicReduction::reduced_solution(const BlockVector& r) const {
  std::vector<BlockVector> rhs{r};
  for (std::size_t l = 0; l + 1 < levels_.size(); ++l) {
    const Level& level = levels_[l];
    const BlockVector& fine = rhs.back();
    BlockVector half;
    for (std::size_t k = 0; k < fine.size(); k += 2) half.push_back(fine[k]);
    for (std::size_t j = 1; j < fine.size(); j += 2) {
      half[j / 2].noalias() -= level.left[j / 2].transpose() * fine[j];
      if (j + 1 < fine.size())
        half[j / 2 + 1].noalias() -= level.right[j / 2].transpose() * fine[j];
    }
    rhs.push_back(std::move(half));
  }
  BlockVector x{last_.solve(rhs.back()[0])};
  for (std::size_t l = levels_.size() - 1; l-- > 0;) {
    const Level& level = levels_[l];
    BlockVector fine(rhs[l].size());
    for (std::size_t k = 0; k < fine.size(); k += 2) fine[k] = x[k / 2];
    for (std::size_t j = 1; j < fine.size(); j += 2) {
      fine[j] = level.pivots[j / 2].solve(rhs[l][j]) - level.left[j / 2] * fine[j - 1];
      if (j + 1 < fine.size()) fine[j].noalias() -= level.right[j / 2] * fine[j + 1];
    }
    x = std::move(fine);
  }
  return x;
}

}  // namespace rtg

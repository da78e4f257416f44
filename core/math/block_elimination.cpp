#include <cmath>

#include "core/math/kkt_solvers.hpp"

namespace rtg {

bool PivotBlock::factorize(const MatrixXd& A) {
  if (!A.allFinite()) return false;
  lu_.compute(A);
  const auto pivots = lu_.matrixLU().diagonal().cwiseAbs();
  return pivots.size() == 0 || pivots.minCoeff() > kLeastPivotRatio * pivots.maxCoeff();
}

/// Computes the pivots S_{N-1} = A_{N-1}, S_{k-1} = A_{k-1} - B_kᵀ S_k⁻¹ B_k.
bool BlockElimination::factorize(const BlockTridiagonal& K) {
  const std::size_t N = K.blocks();
  pivots_.resize(N);
  gain_.resize(N);
  B_ = K.B;
  MatrixXd pivot = K.A[N - 1];
  for (std::size_t k = N; k-- > 0;) {
    if (!pivots_[k].factorize(pivot)) return false;
    if (k == 0) break;
    gain_[k] = pivots_[k].solve(B_[k]);
    pivot = K.A[k - 1];
    pivot.noalias() -= B_[k].transpose() * gain_[k];
  }
  return true;
}

BlockVector BlockElimination::solve(const BlockVector& r) const {
  BlockVector x = r;
  for (std::size_t k = x.size(); k-- > 1;) x[k - 1].noalias() -= gain_[k].transpose() * x[k];
  x[0] = pivots_[0].solve(x[0]).eval();
  for (std::size_t k = 1; k < x.size(); ++k) {
    x[k] = pivots_[k].solve(x[k]).eval();
    x[k].noalias() -= gain_[k] * x[k - 1];
  }
  return x;
}

}  // namespace rtg

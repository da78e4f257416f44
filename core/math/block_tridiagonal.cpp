#include "core/math/block_tridiagonal.hpp"

namespace rtg {

Eigen::Index BlockTridiagonal::order() const {
  Eigen::Index n = 0;
  for (const MatrixXd& block : A) n += block.rows();
  return n;
}

MatrixXd BlockTridiagonal::dense() const {
  MatrixXd M = MatrixXd::Zero(order(), order());
  Eigen::Index at = 0, before = 0;
  for (std::size_t k = 0; k < blocks(); ++k) {
    M.block(at, at, A[k].rows(), A[k].cols()) = A[k];
    if (k > 0) {
      M.block(at, before, B[k].rows(), B[k].cols()) = B[k];
      M.block(before, at, B[k].cols(), B[k].rows()) = B[k].transpose();
    }
    before = at;
    at += A[k].rows();
  }
  return M;
}

BlockVector product(const BlockTridiagonal& K, const BlockVector& x) {
  BlockVector y(K.blocks());
  for (std::size_t k = 0; k < K.blocks(); ++k) {
    y[k] = K.A[k] * x[k];
    if (k > 0) y[k] += K.B[k] * x[k - 1];
    if (k + 1 < K.blocks()) y[k] += K.B[k + 1].transpose() * x[k + 1];
  }
  return y;
}

Eigen::SparseMatrix<double> sparse(const BlockTridiagonal& K) {
  Eigen::SparseMatrix<double> S(K.order(), K.order());
  Eigen::Index at = 0, before = 0, column = 0;
  const auto append = [&](const auto& entries, Eigen::Index first) {
    for (Eigen::Index i = 0; i < entries.size(); ++i)
      if (entries[i] != 0.0) S.insertBack(first + i, column) = entries[i];
  };
  for (std::size_t k = 0; k < K.blocks(); ++k) {
    const Eigen::Index n = K.A[k].rows();
    for (Eigen::Index j = 0; j < n; ++j, ++column) {
      S.startVec(column);
      if (k > 0) append(K.B[k].row(j), before);
      append(K.A[k].col(j), at);
      if (k + 1 < K.blocks()) append(K.B[k + 1].col(j), at + n);
    }
    before = at;
    at += n;
  }
  S.finalize();
  return S;
}

VectorXd joined(const BlockVector& x) {
  Eigen::Index n = 0, at = 0;
  for (const VectorXd& block : x) n += block.size();
  VectorXd all(n);
  for (const VectorXd& block : x) {
    all.segment(at, block.size()) = block;
    at += block.size();
  }
  return all;
}

BlockVector split_like(const BlockTridiagonal& K, const VectorXd& x) {
  BlockVector parts(K.blocks());
  Eigen::Index at = 0;
  for (std::size_t k = 0; k < K.blocks(); ++k) {
    parts[k] = x.segment(at, K.A[k].rows());
    at += K.A[k].rows();
  }
  return parts;
}

}  // namespace rtg

#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "core/math/vectors.hpp"

namespace rtg {

/// Symmetric block-tridiagonal matrix of N block rows:
///
///     ⎡ A₀  B₁ᵀ         ⎤
///     ⎢ B₁  A₁  B₂ᵀ     ⎥    A[k]  [n_k × n_k]      symmetric, may be indefinite
///     ⎢     B₂  A₂   ⋱  ⎥    B[k]  [n_k × n_{k-1}]  B[0] is empty
///     ⎣          ⋱   ⋱  ⎦
struct BlockTridiagonal {
  std::vector<MatrixXd> A, B;

  std::size_t blocks() const { return A.size(); }
  Eigen::Index order() const;  // Σ n_k
  MatrixXd dense() const;      // for tests and small problems only
};

/// A vector of N blocks, [n_k] each.
using BlockVector = std::vector<VectorXd>;

/// Returns K x.
BlockVector product(const BlockTridiagonal& K, const BlockVector& x);

/// Returns the entries of K other than zero, compressed by columns.
Eigen::SparseMatrix<double> sparse(const BlockTridiagonal& K);

/// Concatenates the blocks of `x`. split_like() does the reverse, with the block sizes of `K`.
VectorXd joined(const BlockVector& x);
BlockVector split_like(const BlockTridiagonal& K, const VectorXd& x);

}  // namespace rtg

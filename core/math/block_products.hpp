#pragma once

#include "core/math/register_sum.hpp"

namespace rtg {

/// Returns block (i, j) of Aᵀ; zero if it is outside the pattern.
template <class T>
RegisterSum<Block<T>> transposed(const BlockMatrix<T>& A, int i, int j) {
  return A.has(j, i) ? RegisterSum<Block<T>>(A.at(j, i).transpose()) : RegisterSum<Block<T>>();
}

/// Calls `use` with block (i, j) of a symmetric matrix X and returns the result. X has M × M
/// blocks, stored row by row; only the upper half is read.
template <class T, class Use>
decltype(auto) with_upper(const std::vector<Block<T>>& X, int M, int i, int j, const Use& use) {
  return i <= j ? use(X[i * M + j]) : use(X[j * M + i].transpose());
}

/// sum ← sum + (A x)_i.
template <class T>
void add_row(RegisterSum<Vec3<T>>& sum, const BlockMatrix<T>& A, int i, const BlockColumn<T>& x) {
  for (const int j : Bits(A.pattern[i])) sum.add(A.at(i, j), x[j]);
}

/// sum ← sum + (Aᵀ x)_i.
template <class T>
void add_column(RegisterSum<Vec3<T>>& sum, const BlockMatrix<T>& A, int i,
                const BlockColumn<T>& x) {
  for (const int j : Bits(A.column(i))) sum.add(A.at(j, i).transpose(), x[j]);
}

/// sum ← sum + (A x)_i for a symmetric A. Reads the lower half of A only.
template <class T>
void add_symmetric_row(RegisterSum<Vec3<T>>& sum, const BlockMatrix<T>& A, int i,
                       const BlockColumn<T>& x) {
  for (const int j : Bits(A.pattern[i])) {
    if (j > i) break;
    sum.add(A.at(i, j), x[j]);
  }
  for (const int j : Bits(A.column(i)))
    if (j > i) sum.add(A.at(j, i).transpose(), x[j]);
}

}  // namespace rtg

#pragma once

#include "core/math/register_sum.hpp"

namespace rtg {

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

/// sum ← sum + (A x)_i for a symmetric A, whose lower half counts.
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

#pragma once

#include "core/math/register_sum.hpp"

namespace rtg {

/// y ← y + A x.
template <class T>
void add_to(BlockColumn<T>& y, const BlockMatrix<T>& A, const BlockColumn<T>& x) {
  for (int i = 0; i < A.M; ++i) {
    RegisterSum<Vec3<T>> sum(y[i]);
    for (const int j : Bits(A.pattern[i])) sum.add(A.at(i, j), x[j]);
    sum.store(y[i]);
  }
}

template <class T>
void add_product(Vec3<T>& y, const Block<T>& A, const Vec3<T>& x) {
  RegisterSum<Vec3<T>> sum(y);
  sum.add(A, x);
  sum.store(y);
}
template <class T>
void add_transposed_product(Vec3<T>& y, const Block<T>& A, const Vec3<T>& x) {
  RegisterSum<Vec3<T>> sum(y);
  sum.add(A.transpose(), x);
  sum.store(y);
}

/// y ← y + Aᵀ x.
template <class T>
void add_transposed_to(BlockColumn<T>& y, const BlockMatrix<T>& A, const BlockColumn<T>& x) {
  for (int i = 0; i < A.M; ++i)
    for (const int j : Bits(A.pattern[i])) add_transposed_product(y[j], A.at(i, j), x[i]);
}

/// y ← y - Aᵀ x.
template <class T>
void subtract_transposed(BlockColumn<T>& y, const BlockMatrix<T>& A, const BlockColumn<T>& x) {
  for (int i = 0; i < A.M; ++i)
    for (const int j : Bits(A.pattern[i])) {
      RegisterSum<Vec3<T>> less(y[j]);
      less.subtract(A.at(i, j).transpose(), x[i]);
      less.store(y[j]);
    }
}

/// y ← y + A x for a symmetric A, whose lower half counts.
template <class T>
void add_symmetric_to(BlockColumn<T>& y, const BlockMatrix<T>& A, const BlockColumn<T>& x) {
  for (int i = 0; i < A.M; ++i)
    for (const int j : Bits(A.pattern[i])) {
      if (j > i) break;
      add_product(y[i], A.at(i, j), x[j]);
      if (j < i) add_transposed_product(y[j], A.at(i, j), x[i]);
    }
}

}  // namespace rtg

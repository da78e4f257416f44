#pragma once

#include "core/math/register_sum.hpp"

namespace rtg {

/// A = L D Lᵀ of a symmetric block matrix, in the order of the bodies and without pivoting beyond
/// the 3 × 3 blocks of D; L has a unit diagonal and the pattern of A's lower half with its fill.
template <class T>
class BlockLdl {
 public:
  explicit BlockLdl(int count = 0)
      : L_(count), inverse_(static_cast<std::size_t>(count)), column_(inverse_) {}

  /// Reads the lower half of A. Returns in which lanes A is positive definite.
  Mask<T> factorize(const BlockMatrix<T>& A);
  /// Whether no block of D was singular.
  const Mask<T>& regular() const { return regular_; }

  /// x ← A⁻¹ x.
  void solve(Vec3<T>* x) const;

  /// r ← r A⁻¹ for a row r of M blocks. Those before `first` are zero; the result is wanted from
  /// `from` on.
  void solve_row(Block<T>* r, int first, int from) const;

 private:
  std::uint64_t before(int i) const { return L_.pattern[i] & ((std::uint64_t{1} << i) - 1); }
  std::uint64_t after(int i) const { return L_.pattern[i] & ~((std::uint64_t{2} << i) - 1); }

  BlockMatrix<T> L_;               // strictly lower half; (j, i) of the pattern beside (i, j)
  std::vector<Block<T>> inverse_;  // D_i⁻¹
  std::vector<Block<T>> column_;   // of A, what is left of it
  Mask<T> regular_ = Mask<T>(true);
};

template <class T>
Mask<T> BlockLdl<T>::factorize(const BlockMatrix<T>& A) {
  const int M = A.M;
  L_.clear();
  for (int i = 0; i < M; ++i)
    for (const int j : Bits(A.pattern[i])) {
      if (j > i) break;
      L_.at(i, j) = A.at(i, j);
      L_.pattern[i] |= std::uint64_t{1} << j;
      L_.pattern[j] |= std::uint64_t{1} << i;
    }
  Mask<T> positive(true);
  regular_ = Mask<T>(true);
  for (int i = 0; i < M; ++i) {
    const Block<T> D = L_.at(i, i);
    T determinant;
    inverse_[i] = symmetric_inverse(D, determinant);
    regular_ = regular_ && is_regular(D, determinant);
    positive = positive && D(0, 0) > T(0.0) && D(0, 0) * D(1, 1) - D(1, 0) * D(1, 0) > T(0.0) &&
               determinant > T(0.0);
    const std::uint64_t below = after(i);
    for (const int j : Bits(below)) {
      column_[j] = L_.at(j, i);
      RegisterSum<Block<T>> scaled;
      scaled.add(column_[j], inverse_[i]);
      scaled.store(L_.at(j, i));
      for (const int k : Bits(below & ((std::uint64_t{2} << j) - 1))) {
        if (!L_.has(j, k)) {
          L_.at(j, k).setConstant(T(0.0));
          L_.pattern[j] |= std::uint64_t{1} << k;
          L_.pattern[k] |= std::uint64_t{1} << j;
        }
        RegisterSum<Block<T>> rest(L_.at(j, k));
        rest.subtract(L_.at(j, i), column_[k].transpose());
        rest.store(L_.at(j, k));
      }
    }
  }
  return positive;
}

template <class T>
void BlockLdl<T>::solve(Vec3<T>* x) const {
  for (int i = 1; i < L_.M; ++i) {
    RegisterSum<Vec3<T>> sum(x[i]);
    for (const int k : Bits(before(i))) sum.subtract(L_.at(i, k), x[k]);
    sum.store(x[i]);
  }
  for (int i = L_.M; i-- > 0;) {
    RegisterSum<Vec3<T>> sum;
    sum.add(inverse_[i], x[i]);
    for (const int k : Bits(after(i))) sum.subtract(L_.at(k, i).transpose(), x[k]);
    sum.store(x[i]);
  }
}

template <class T>
void BlockLdl<T>::solve_row(Block<T>* r, int first, int from) const {
  const std::uint64_t filled = ~((std::uint64_t{1} << first) - 1);
  for (int i = first + 1; i < L_.M; ++i) {
    const std::uint64_t terms = before(i) & filled;
    if (terms == 0) continue;
    RegisterSum<Block<T>> sum(r[i]);
    for (const int k : Bits(terms)) sum.subtract(r[k], L_.at(i, k).transpose());
    sum.store(r[i]);
  }
  for (int i = L_.M; i-- > from;) {
    RegisterSum<Block<T>> sum;
    if (i >= first) sum.add(r[i], inverse_[i]);
    for (const int k : Bits(after(i))) sum.subtract(r[k], L_.at(k, i));
    sum.store(r[i]);
  }
}

}  // namespace rtg

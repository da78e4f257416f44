#pragma once

#include "core/math/register_sum.hpp"

namespace rtg {

/// Factorisation A = L D Lᵀ of a symmetric block matrix, without pivoting. D consists of 3 × 3
/// blocks, one per body, in the order of the bodies. L has a unit diagonal. Its pattern is that of
/// A's lower half plus fill-in.
template <class T>
class BlockLdl {
 public:
  explicit BlockLdl(int count = 0)
      : L_(count), inverse_(static_cast<std::size_t>(count)), row_(inverse_) {}

  /// Factorises A, reading its lower half only. Returns the lanes in which A is positive definite.
  Mask<T> factorize(const BlockMatrix<T>& A);
  /// Returns the lanes in which no block of D is singular.
  const Mask<T>& regular() const { return regular_; }

  /// x ← A⁻¹ x.
  void solve(Vec3<T>* x) const;

  /// out ← r A⁻¹ for a row r of M blocks. `load(i)` returns the block r_i as a RegisterSum. The
  /// blocks r_i with i < `first` are zero and not loaded. Of the result, only the blocks `out[i]`
  /// with i ≥ `from` are computed; the others are arbitrary.
  template <class Load>
  void solve_row(const Load& load, int first, int from, Block<T>* out) const;

 private:
  void eliminate_row(const BlockMatrix<T>& A, int i);
  std::uint64_t before(int i) const { return L_.pattern[i] & ((std::uint64_t{1} << i) - 1); }
  std::uint64_t after(int i) const { return L_.pattern[i] & ~((std::uint64_t{2} << i) - 1); }

  BlockMatrix<T> L_;               // strictly lower half; the pattern is symmetric
  std::vector<Block<T>> inverse_;  // D_i⁻¹
  std::vector<Block<T>> row_;      // the current row of L D
  Mask<T> regular_ = Mask<T>(true);
};

template <class T>
Mask<T> BlockLdl<T>::factorize(const BlockMatrix<T>& A) {
  L_.clear();
  Mask<T> positive(true);
  regular_ = Mask<T>(true);
  for (int i = 0; i < A.M; ++i) {
    eliminate_row(A, i);
    RegisterSum<Block<T>> rest(A.at(i, i));
    for (const int j : Bits(before(i))) {
      RegisterSum<Block<T>> scaled;
      scaled.add(row_[j], inverse_[j]);
      scaled.store(L_.at(i, j));
      rest.subtract(row_[j], L_.at(i, j).transpose());
    }
    Block<T> D;
    rest.store(D);
    const SymmetricInverse<T> inverted(D);
    inverse_[i] = inverted.inverse;
    regular_ = regular_ && inverted.regular;
    positive = positive && inverted.positive;
  }
  return positive;
}

/// Computes row `i` of L D left of the diagonal, and its sparsity pattern.
template <class T>
void BlockLdl<T>::eliminate_row(const BlockMatrix<T>& A, int i) {
  for (int j = 0; j < i; ++j) {
    const std::uint64_t terms = before(i) & before(j);
    if (!A.has(i, j) && terms == 0) continue;
    RegisterSum<Block<T>> sum =
        A.has(i, j) ? RegisterSum<Block<T>>(A.at(i, j)) : RegisterSum<Block<T>>();
    for (const int k : Bits(terms)) sum.subtract(row_[k], L_.at(j, k).transpose());
    sum.store(row_[j]);
    L_.pattern[i] |= std::uint64_t{1} << j;
    L_.pattern[j] |= std::uint64_t{1} << i;
  }
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
template <class Load>
void BlockLdl<T>::solve_row(const Load& load, int first, int from, Block<T>* out) const {
  if (first == L_.M) {
    for (int i = from; i < L_.M; ++i) out[i].setConstant(T(0.0));
    return;
  }
  const std::uint64_t filled = ~((std::uint64_t{1} << first) - 1);
  for (int i = first; i < L_.M; ++i) {
    RegisterSum<Block<T>> sum = load(i);
    for (const int k : Bits(before(i) & filled)) sum.subtract(out[k], L_.at(i, k).transpose());
    sum.store(out[i]);
  }
  for (int i = L_.M; i-- > from;) {
    RegisterSum<Block<T>> sum;
    if (i >= first) sum.add(out[i], inverse_[i]);
    for (const int k : Bits(after(i))) sum.subtract(out[k], L_.at(k, i));
    sum.store(out[i]);
  }
}

}  // namespace rtg

#pragma once

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstdint>
#include <vector>

#include "core/math/lanes.hpp"
#include "core/math/vectors.hpp"

namespace rtg {

template <class T>
using Block = Eigen::Matrix<T, 3, 3>;

/// Sparsity pattern of a matrix of at most 64 × 64 blocks. Bit j of entry i is set if block (i, j)
/// may be non-zero in some lane.
using BlockPattern = std::vector<std::uint64_t>;

/// Square matrix of M × M blocks of size 3 × 3, stored row by row. It has a block row and a block
/// column per body. Blocks outside the pattern count as zero and are never read.
template <class T>
struct BlockMatrix {
  explicit BlockMatrix(int count = 0)
      : M(count),
        blocks(static_cast<std::size_t>(count) * static_cast<std::size_t>(count)),
        pattern(static_cast<std::size_t>(count)) {
    assert(count <= 64);
  }

  Block<T>& at(int i, int j) { return blocks[index(i, j)]; }
  const Block<T>& at(int i, int j) const { return blocks[index(i, j)]; }
  bool has(int i, int j) const { return (pattern[static_cast<std::size_t>(i)] >> j & 1U) != 0; }

  /// Adds X to block (i, j). Extends the pattern by this block if necessary.
  template <class Summand>
  void add(int i, int j, const Summand& X) {
    if (has(i, j)) {
      at(i, j) += X;
    } else {
      pattern[static_cast<std::size_t>(i)] |= std::uint64_t{1} << j;
      at(i, j) = X;
    }
  }
  /// Returns the pattern of column `j`: bit i is set if block (i, j) is in the pattern.
  std::uint64_t column(int j) const {
    std::uint64_t rows = 0;
    for (int i = 0; i < M; ++i) rows |= std::uint64_t{has(i, j)} << i;
    return rows;
  }
  void clear() { pattern.assign(pattern.size(), 0); }
  bool empty() const {
    return std::ranges::all_of(pattern, [](std::uint64_t row) { return row == 0; });
  }

  int M;
  std::vector<Block<T>> blocks;
  BlockPattern pattern;

 private:
  std::size_t index(int i, int j) const {
    return static_cast<std::size_t>(i) * static_cast<std::size_t>(M) + static_cast<std::size_t>(j);
  }
};

/// A vector of M blocks of 3 entries.
template <class T>
using BlockColumn = std::vector<Vec3<T>>;

/// Range over the indices of the set bits of a word, in ascending order:
///   for (const int j : Bits(pattern[i])) ...
class Bits {
 public:
  explicit Bits(std::uint64_t bits) : bits_(bits) {}
  struct Iterator {
    std::uint64_t rest;
    int operator*() const { return std::countr_zero(rest); }
    Iterator& operator++() {
      rest &= rest - 1;
      return *this;
    }
    bool operator!=(const Iterator& other) const { return rest != other.rest; }
  };
  Iterator begin() const { return {bits_}; }
  Iterator end() const { return {0}; }

 private:
  std::uint64_t bits_;
};

template <class T>
Block<T> diagonal(const Vec3<T>& entries) {
  Block<T> D = Block<T>::Constant(T(0.0));
  for (int m = 0; m < 3; ++m) D(m, m) = entries[m];
  return D;
}

/// The inverse of a symmetric block A, of which only the lower half is read. Where A is positive
/// definite, the inverse comes from A = L D Lᵀ, as accurate as the ratio of its largest to its
/// smallest eigenvalue permits; a contact makes that ratio 1e10 and more. Elsewhere it comes from
/// cofactors, which are not accurate for stiff blocks: those count as singular.
template <class T>
struct SymmetricInverse {
  Block<T> inverse;
  Mask<T> positive;  // lanes in which A is positive definite, rounding errors apart
  Mask<T> regular;   // lanes in which `inverse` is accurate

  explicit SymmetricInverse(const Block<T>& A) {
    const T i0 = T(1.0) / A(0, 0), l10 = A(1, 0) * i0, l20 = A(2, 0) * i0;
    const T d1 = A(1, 1) - l10 * A(1, 0), s21 = A(2, 1) - l10 * A(2, 0);
    const T i1 = T(1.0) / d1, l21 = s21 * i1;
    const T d2 = A(2, 2) - l20 * A(2, 0) - l21 * s21, i2 = T(1.0) / d2;
    const T m20 = l10 * l21 - l20;
    const T out20 = m20 * i2, out21 = -l21 * i2;
    const T out10 = -l10 * i1 + m20 * out21;
    inverse << i0 + l10 * l10 * i1 + m20 * out20, out10, out20,  //
        out10, i1 - l21 * out21, out21,                          //
        out20, out21, i2;
    positive = A(0, 0) > T(0.0) && d1 > T(kRounding) * A(1, 1) && d2 > T(kRounding) * A(2, 2);
    regular = positive;
    if (any(!positive)) by_cofactors(A);
  }

 private:
  static constexpr double kRounding = 1e-14;

  void by_cofactors(const Block<T>& A) {
    const T c00 = A(1, 1) * A(2, 2) - A(2, 1) * A(2, 1);
    const T c10 = A(2, 0) * A(2, 1) - A(1, 0) * A(2, 2);
    const T c20 = A(1, 0) * A(2, 1) - A(2, 0) * A(1, 1);
    const T c11 = A(0, 0) * A(2, 2) - A(2, 0) * A(2, 0);
    const T c21 = A(1, 0) * A(2, 0) - A(0, 0) * A(2, 1);
    const T c22 = A(0, 0) * A(1, 1) - A(1, 0) * A(1, 0);
    const T determinant = A(0, 0) * c00 + A(1, 0) * c10 + A(2, 0) * c20;
    const T scale = T(1.0) / determinant;
    Block<T> other;
    other << c00, c10, c20, c10, c11, c21, c20, c21, c22;
    T size(0.0);
    for (int m = 0; m < 3; ++m)
      for (int n = 0; n <= m; ++n) size = greater(size, magnitude(A(m, n)));
    regular = positive || magnitude(determinant) > T(kRounding) * size * size * size;
    for (int k = 0; k < 9; ++k)
      inverse.data()[k] = select(positive, inverse.data()[k], other.data()[k] * scale);
  }
};

}  // namespace rtg

#pragma once

#include "core/math/block_matrix.hpp"

namespace rtg {

/// Accumulator for a sum of blocks X and of products A B of blocks. Each entry is a member of its
/// own, so that the compiler keeps the sum in registers. It would keep a local Eigen matrix in
/// memory.
///
/// A is 3 × 3. B, X and the sum are all 3 × 3 or all 3 × 1. Arguments of 3 × 3 may be transposes.
template <class Entry>
class RegisterSum;

template <class T>
class RegisterSum<Block<T>> {
 public:
  RegisterSum() : a_(0.0), b_(0.0), c_(0.0), d_(0.0), e_(0.0), f_(0.0), g_(0.0), h_(0.0), i_(0.0) {}
  template <class Summand>
  explicit RegisterSum(const Summand& X)
      : a_(X(0, 0)),
        b_(X(1, 0)),
        c_(X(2, 0)),
        d_(X(0, 1)),
        e_(X(1, 1)),
        f_(X(2, 1)),
        g_(X(0, 2)),
        h_(X(1, 2)),
        i_(X(2, 2)) {}

  template <class Left, class Right>
  void add(const Left& A, const Right& B) {
    for (int k = 0; k < 3; ++k) {
      const T x = A(0, k), y = A(1, k), z = A(2, k), u = B(k, 0), v = B(k, 1), w = B(k, 2);
      a_ = plus_product(a_, x, u), b_ = plus_product(b_, y, u), c_ = plus_product(c_, z, u);
      d_ = plus_product(d_, x, v), e_ = plus_product(e_, y, v), f_ = plus_product(f_, z, v);
      g_ = plus_product(g_, x, w), h_ = plus_product(h_, y, w), i_ = plus_product(i_, z, w);
    }
  }
  template <class Left, class Right>
  void subtract(const Left& A, const Right& B) {
    for (int k = 0; k < 3; ++k) {
      const T x = A(0, k), y = A(1, k), z = A(2, k), u = B(k, 0), v = B(k, 1), w = B(k, 2);
      a_ = minus_product(a_, x, u), b_ = minus_product(b_, y, u), c_ = minus_product(c_, z, u);
      d_ = minus_product(d_, x, v), e_ = minus_product(e_, y, v), f_ = minus_product(f_, z, v);
      g_ = minus_product(g_, x, w), h_ = minus_product(h_, y, w), i_ = minus_product(i_, z, w);
    }
  }
  template <class Summand>
  void add(const Summand& X) {
    a_ = a_ + X(0, 0), b_ = b_ + X(1, 0), c_ = c_ + X(2, 0);
    d_ = d_ + X(0, 1), e_ = e_ + X(1, 1), f_ = f_ + X(2, 1);
    g_ = g_ + X(0, 2), h_ = h_ + X(1, 2), i_ = i_ + X(2, 2);
  }
  template <class Summand>
  void subtract(const Summand& X) {
    a_ = a_ - X(0, 0), b_ = b_ - X(1, 0), c_ = c_ - X(2, 0);
    d_ = d_ - X(0, 1), e_ = e_ - X(1, 1), f_ = f_ - X(2, 1);
    g_ = g_ - X(0, 2), h_ = h_ - X(1, 2), i_ = i_ - X(2, 2);
  }
  void scale(const T& by) {
    a_ = a_ * by, b_ = b_ * by, c_ = c_ * by, d_ = d_ * by, e_ = e_ * by;
    f_ = f_ * by, g_ = g_ * by, h_ = h_ * by, i_ = i_ * by;
  }
  void store(Block<T>& X) const {
    X(0, 0) = a_, X(1, 0) = b_, X(2, 0) = c_;
    X(0, 1) = d_, X(1, 1) = e_, X(2, 1) = f_;
    X(0, 2) = g_, X(1, 2) = h_, X(2, 2) = i_;
  }
  void store_transposed(Block<T>& X) const {
    X(0, 0) = a_, X(0, 1) = b_, X(0, 2) = c_;
    X(1, 0) = d_, X(1, 1) = e_, X(1, 2) = f_;
    X(2, 0) = g_, X(2, 1) = h_, X(2, 2) = i_;
  }

 private:
  T a_, b_, c_, d_, e_, f_, g_, h_, i_;
};

template <class T>
class RegisterSum<Vec3<T>> {
 public:
  RegisterSum() : a_(0.0), b_(0.0), c_(0.0) {}
  explicit RegisterSum(const Vec3<T>& x) : a_(x[0]), b_(x[1]), c_(x[2]) {}

  template <class Left>
  void add(const Left& A, const Vec3<T>& x) {
    for (int k = 0; k < 3; ++k)
      a_ = plus_product(a_, A(0, k), x[k]), b_ = plus_product(b_, A(1, k), x[k]),
      c_ = plus_product(c_, A(2, k), x[k]);
  }
  template <class Left>
  void subtract(const Left& A, const Vec3<T>& x) {
    for (int k = 0; k < 3; ++k)
      a_ = minus_product(a_, A(0, k), x[k]), b_ = minus_product(b_, A(1, k), x[k]),
      c_ = minus_product(c_, A(2, k), x[k]);
  }
  void add(const Vec3<T>& x) { a_ = a_ + x[0], b_ = b_ + x[1], c_ = c_ + x[2]; }
  void subtract(const Vec3<T>& x) { a_ = a_ - x[0], b_ = b_ - x[1], c_ = c_ - x[2]; }
  void store(Vec3<T>& x) const { x[0] = a_, x[1] = b_, x[2] = c_; }

 private:
  T a_, b_, c_;
};

}  // namespace rtg

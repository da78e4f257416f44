#pragma once

#include "core/energy/pair_frame.hpp"

namespace rtg::energy {

/// A vertex v of body i in the frame of body j: x = offset + a with the arm a = R(θ_i - θ_j) v. As
/// a function of the pair's coordinates u (PairFrame) it has the derivatives
///
///   ∂x/∂u = X = [ I₂ | E a | -E x ].
///
/// Its second derivatives are zero except for those that involve the angles. The derivatives (ẋ, ȧ)
/// along a motion y have the form of a ContactPoint, too; see along().
template <class T>
struct ContactPoint {
  Vec2<T> x, a;  // [m]

  ContactPoint() = default;
  ContactPoint(const Vec2<T>& vertex, const PairFrame<T>& pair)
      : a(pair.across.c * vertex.x() - pair.across.s * vertex.y(),
          pair.across.s * vertex.x() + pair.across.c * vertex.y()) {
    x = pair.offset + a;
  }

  /// Returns (ẋ, ȧ) along y.
  ContactPoint along(const Vec4<T>& y) const {
    ContactPoint rate;
    rate.a = turned(a) * (y[2] - y[3]);
    rate.x = pushed(y);
    return rate;
  }

  /// X y.
  Vec2<T> pushed(const Vec4<T>& y) const {
    return {y[0] - a.y() * y[2] + x.y() * y[3], y[1] + a.x() * y[2] - x.x() * y[3]};
  }
  /// Xᵀ w.
  Vec4<T> pulled(const Vec2<T>& w) const {
    return {w.x(), w.y(), a.x() * w.y() - a.y() * w.x(), x.y() * w.x() - x.x() * w.y()};
  }
  /// Ẋᵀ w, if this is (ẋ, ȧ): as Xᵀ w, but without the part of I₂, which is constant.
  Vec4<T> pulled_rate(const Vec2<T>& w) const {
    Vec4<T> out = pulled(w);
    out[0] = out[1] = T(0.0);
    return out;
  }

  /// Xᵀ D Y, with Y the matrix X of another point.
  Mat4<T> pulled(const Mat2<T>& D, const ContactPoint& other) const {
    Mat4<T> out;
    const Vec4<T> top = other.pulled(Vec2<T>(D(0, 0), D(0, 1)));
    const Vec4<T> bottom = other.pulled(Vec2<T>(D(1, 0), D(1, 1)));
    for (int m = 0; m < 4; ++m) {
      out(0, m) = top[m];
      out(1, m) = bottom[m];
      out(2, m) = a.x() * bottom[m] - a.y() * top[m];
      out(3, m) = x.y() * top[m] - x.x() * bottom[m];
    }
    return out;
  }
  /// Ẋᵀ D Y, if this is (ẋ, ȧ).
  Mat4<T> pulled_rate(const Mat2<T>& D, const ContactPoint& other) const {
    Mat4<T> out = pulled(D, other);
    out.row(0).setConstant(T(0.0));
    out.row(1).setConstant(T(0.0));
    return out;
  }
  /// Adds the second derivatives of x with respect to q, contracted with w and expressed in u.
  void add_curvature(const Vec2<T>& w, Mat4<T>& H) const {
    add_curvature_rate(w, H);
    H(0, 3) -= w.y();
    H(3, 0) -= w.y();
    H(1, 3) += w.x();
    H(3, 1) += w.x();
  }
  /// Does the same if this is (ẋ, ȧ): without the part mixed with the offset, which is constant.
  void add_curvature_rate(const Vec2<T>& w, Mat4<T>& H) const {
    const T arm = w.dot(a);
    H(2, 2) -= arm;
    H(2, 3) += arm;
    H(3, 2) += arm;
    H(3, 3) -= w.dot(x);
  }
};

}  // namespace rtg::energy

#pragma once

#include "core/energy/pair_frame.hpp"

namespace rtg::energy {

/// A vertex v of body i, seen in the frame of body j:
///
///   x = offset + a,   a = R(θ_i - θ_j) v  (the arm),   ∂x/∂u = X = [ I₂ | E a | -E x ].
///
/// `offset` and the coordinates u of the pair are those of PairFrame. The second derivatives of x
/// are zero except for those that involve an angle.
///
/// A round corner has its centre at v and the radius r. Its surface rolls by r (θ_i - θ_j) relative
/// to body j.
///
/// A ContactPoint can also hold the rates (ẋ, ȧ) along a motion y, as returned by along(). The
/// member functions pulled_rate() and add_curvature_rate() are meant for such an object.
template <class T>
struct ContactPoint {
  Vec2<T> x, a;        // [m]
  T radius{}, roll{};  // r, r (θ_i - θ_j) [m]

  ContactPoint() = default;
  ContactPoint(const Vec2<T>& vertex, const PairFrame<T>& pair, const T& rounding)
      : a(pair.across.c * vertex.x() - pair.across.s * vertex.y(),
          pair.across.s * vertex.x() + pair.across.c * vertex.y()),
        radius(rounding),
        roll(rounding * pair.turn) {
    x = pair.offset + a;
  }

  /// Returns the rates (ẋ, ȧ) along the motion `y` in u.
  ContactPoint along(const Vec4<T>& y) const {
    ContactPoint rate;
    rate.a = turned(a) * (y[2] - y[3]);
    rate.x = pushed(y);
    rate.roll = radius * (y[2] - y[3]);
    return rate;
  }

  /// Returns X y.
  Vec2<T> pushed(const Vec4<T>& y) const {
    return {y[0] - a.y() * y[2] + x.y() * y[3], y[1] + a.x() * y[2] - x.x() * y[3]};
  }
  /// Returns ∂roll/∂u.
  Vec4<T> roll_gradient() const { return {T(0.0), T(0.0), radius, -radius}; }
  /// Returns Xᵀ w.
  Vec4<T> pulled(const Vec2<T>& w) const {
    return {w.x(), w.y(), a.x() * w.y() - a.y() * w.x(), x.y() * w.x() - x.x() * w.y()};
  }
  /// Returns Ẋᵀ w if this is (ẋ, ȧ). Unlike in Xᵀ w, the first two entries are zero, because I₂ is
  /// constant.
  Vec4<T> pulled_rate(const Vec2<T>& w) const {
    Vec4<T> out = pulled(w);
    out[0] = out[1] = T(0.0);
    return out;
  }

  /// Returns Xᵀ D Y, with Y the matrix X of `other`.
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
  /// Returns Ẋᵀ D Y if this is (ẋ, ȧ).
  Mat4<T> pulled_rate(const Mat2<T>& D, const ContactPoint& other) const {
    Mat4<T> out = pulled(D, other);
    out.row(0).setConstant(T(0.0));
    out.row(1).setConstant(T(0.0));
    return out;
  }
  /// Adds Σ_m w_m ∂²x_m/∂q² to `H`, expressed in u. q are the poses of both bodies.
  void add_curvature(const Vec2<T>& w, Mat4<T>& H) const {
    add_curvature_rate(w, H);
    H(0, 3) -= w.y();
    H(3, 0) -= w.y();
    H(1, 3) += w.x();
    H(3, 1) += w.x();
  }
  /// Adds the rate of the same sum if this is (ẋ, ȧ). Its terms mixed with the offset are zero.
  void add_curvature_rate(const Vec2<T>& w, Mat4<T>& H) const {
    const T arm = w.dot(a);
    H(2, 2) -= arm;
    H(2, 3) += arm;
    H(3, 2) += arm;
    H(3, 3) -= w.dot(x);
  }
};

}  // namespace rtg::energy

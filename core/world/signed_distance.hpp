#pragma once

#include <cstddef>

#include "core/math/elementary_lanes.hpp"
#include "core/math/vectors.hpp"
#include "core/world/polygon.hpp"

namespace rtg {

/// A convex polygon as the intersection of half planes n_k·x ≤ b_k, in the body frame. n_k are the
/// outward unit normals of the edges. Each lane (core/math/lanes.hpp) has its own polygon. If it
/// has fewer than `count` edges, its unused planes and corners are far from everything. A single
/// point, the core of a disc, has one plane, with n = 0 and b = 0.
template <class T>
struct Planes {
  int count = 0;
  Vec2<T> normal[kMaxVertices];
  T offset[kMaxVertices] = {};          // [m]
  Vec2<T> corner[kMaxVertices];         // at which the edge begins [m]
  Vec2<T> edge[kMaxVertices];           // from there to its end [m]
  T inverse_square[kMaxVertices] = {};  // 1/|edge|² [1/m²]; 0 for a point
};
using HalfPlanes = Planes<double>;

HalfPlanes half_planes(const Polygon& shape);

/// Writes the distance n_k·x - b_k of `x` from each plane to `distances`. Returns the largest,
/// which is a lower bound of d(x) (SignedDistance).
template <class T>
T plane_distances(const Planes<T>& planes, const Vec2<T>& x, T* distances) {
  T top = distances[0] = planes.normal[0].dot(x) - planes.offset[0];
  for (int k = 1; k < planes.count; ++k) {
    distances[k] = planes.normal[k].dot(x) - planes.offset[k];
    top = greater(top, distances[k]);
  }
  return top;
}

/// Smoothed signed distance d of a point x to a convex polygon and its derivatives,
///
///   d(x) = 1/α ln Σ_k exp(α (n_k·x - b_k)),   w = softmax(α (n_k·x - b_k)),
///   ∇d = n̄ = Σ w n,   ∇²d = α (Σ w n nᵀ - n̄ n̄ᵀ),   ∇³d = α² Σ w (n - n̄)^⊗3,
///
/// all in the polygon's frame. Far from corners d is exact at the edges. The contour d = 0 cuts
/// right-angled corners by at most √2 ln 2/α.
///
/// Where a body of the contact has round corners, make_exact() replaces d by the distance ρ from
/// the polygon, which at a corner grows along circles, not along mitred edges:
///
///   ∇d = n = (x - nearest)/ρ,   ∇²d = (I - n nᵀ)/ρ at a corner, 0 at an edge.
///
/// ∇²d jumps where edge and corner meet. Inside d is that of the nearest edge line.
template <class T>
class SignedDistance {
 public:
  /// `distances` and `top` are what plane_distances() writes and returns for x. `alpha` is α.
  SignedDistance(const Planes<T>& planes, double alpha, const T* distances, const T& top)
      : planes_(planes), alpha_(alpha) {
    T exponent[kMaxVertices];
    for (int k = 0; k < planes.count; ++k) {
      exponent[k] = T(alpha) * (distances[k] - top);
      weight_[k] = greater(exponent[k], T(kNothing));
    }
    T sum(0.0);
    for (int k = 0; k < planes.count; ++k) {
      weight_[k] = select(exponent[k] > T(kNothing), exponential(weight_[k]), T(0.0));
      sum = sum + weight_[k];
    }
    const T scale = T(1.0) / sum;
    gradient.setConstant(T(0.0));
    for (int k = 0; k < planes.count; ++k) {
      weight_[k] = weight_[k] * scale;
      gradient += planes.normal[k] * weight_[k];
    }
    value = top + logarithm(sum) * T(1.0 / alpha);
  }

  /// Makes d exact in the lanes `where`. `x` and `top` are those of the constructor.
  void make_exact(const Mask<T>& where, const Vec2<T>& x, const T& top) {
    T least(INFINITY), at_corner(0.0);
    Vec2<T> away(T(0.0), T(0.0));
    for (int k = 0; k < planes_.count; ++k) {
      const Vec2<T> from = x - planes_.corner[k];
      const T along = from.dot(planes_.edge[k]) * planes_.inverse_square[k];
      const T nearest = greater(T(0.0), lesser(T(1.0), along));
      const Vec2<T> off = from - planes_.edge[k] * nearest;
      const T square = off.dot(off);
      const Mask<T> nearer = square < least;
      least = select(nearer, square, least);
      at_corner =
          select(nearer, select(along > T(0.0) && along < T(1.0), T(0.0), T(1.0)), at_corner);
      for (int m = 0; m < 2; ++m) away[m] = select(nearer, off[m], away[m]);
    }
    const Mask<T> outside = !(top < T(0.0));
    const T distance = greater(root(least), T(kLeastDistance)), inverse = T(1.0) / distance;
    value = select(where, select(outside, distance, top), value);
    for (int m = 0; m < 2; ++m) gradient[m] = select(where, away[m] * inverse, gradient[m]);
    exact_ = where;
    bend_ = at_corner * inverse;
    any_exact_ = true;
  }

  /// Returns ∇²d [1/m].
  Mat2<T> hessian() const {
    const Mat2<T> smooth = moments([](const T& weight, const Vec2<T>&) { return weight; }, alpha_);
    return any_exact_ ? blend(bent(), smooth) : smooth;
  }
  /// Returns ∇³d contracted with `a`, the derivative of ∇²d along a. Unit: [1/m²] times that of a.
  Mat2<T> third(const Vec2<T>& a) const {
    const Mat2<T> smooth = moments(
        [&a](const T& weight, const Vec2<T>& m) { return weight * m.dot(a); }, alpha_ * alpha_);
    return any_exact_ ? blend(bent_along(a), smooth) : smooth;
  }

  T value;           // d [m]
  Vec2<T> gradient;  // ∇d, |∇d| ≤ 1

 private:
  static constexpr double kNothing = -100.0;       // weights of at most e^-100 are set to zero
  static constexpr double kLeastDistance = 1e-12;  // from a polygon [m]

  /// Returns ∇²d of the exact distance.
  Mat2<T> bent() const {
    const T x = gradient.x(), y = gradient.y();
    Mat2<T> out;
    out << bend_ * (T(1.0) - x * x), -bend_ * x * y, -bend_ * x * y, bend_ * (T(1.0) - y * y);
    return out;
  }
  /// Returns the derivative of bent() along a: -(m nᵀ + n mᵀ + (n·a) ∇²d)/ρ with m = ∇²d a.
  Mat2<T> bent_along(const Vec2<T>& a) const {
    const Mat2<T> D = bent();
    const Vec2<T> m(D(0, 0) * a.x() + D(0, 1) * a.y(), D(1, 0) * a.x() + D(1, 1) * a.y());
    const T onwards = gradient.dot(a);
    const T cross = m.x() * gradient.y() + m.y() * gradient.x();
    Mat2<T> out;
    out << T(2.0) * m.x() * gradient.x(), cross, cross, T(2.0) * m.y() * gradient.y();
    out += D * onwards;
    return out * (-bend_);
  }
  /// Returns `exact` in the lanes in which d is exact, `smooth` in the others.
  Mat2<T> blend(const Mat2<T>& exact, const Mat2<T>& smooth) const {
    Mat2<T> out;
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j) out(i, j) = select(exact_, exact(i, j), smooth(i, j));
    return out;
  }

  /// Returns `scale` · Σ weight(w, n - n̄) (n - n̄)(n - n̄)ᵀ.
  template <class Weight>
  Mat2<T> moments(Weight&& weight, double scale) const {
    T xx(0.0), xy(0.0), yy(0.0);
    for (int k = 0; k < planes_.count; ++k) {
      const Vec2<T> m = planes_.normal[k] - gradient;
      const T w = weight(weight_[k], m);
      xx = xx + w * m.x() * m.x();
      xy = xy + w * m.x() * m.y();
      yy = yy + w * m.y() * m.y();
    }
    Mat2<T> out;
    out << T(scale) * xx, T(scale) * xy, T(scale) * xy, T(scale) * yy;
    return out;
  }

  const Planes<T>& planes_;
  double alpha_;
  T weight_[kMaxVertices];
  bool any_exact_ = false;
  Mask<T> exact_{};  // lanes in which make_exact() has replaced d
  T bend_{};         // 1/ρ at a corner, else 0 [1/m]
};

/// Returns the distance of `x` from one polygon, made exact.
inline SignedDistance<double> exact_distance(const HalfPlanes& planes, const Vector2d& x) {
  double distances[kMaxVertices];
  const double top = plane_distances(planes, x, distances);
  SignedDistance<double> d(planes, 1.0, distances, top);
  d.make_exact(true, x, top);
  return d;
}

/// Returns the smoothed signed distance of `x` to one polygon. `alpha` is α.
inline SignedDistance<double> signed_distance(const HalfPlanes& planes, double alpha,
                                              const Vector2d& x) {
  double distances[kMaxVertices];
  const double top = plane_distances(planes, x, distances);
  return {planes, alpha, distances, top};
}

}  // namespace rtg

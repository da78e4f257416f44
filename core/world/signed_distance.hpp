#pragma once

#include <cstddef>

#include "core/math/elementary.hpp"
#include "core/math/vectors.hpp"
#include "core/world/polygon.hpp"

namespace rtg {

/// A convex polygon as the intersection of half planes n_k·x ≤ b_k, in the body frame. n_k are the
/// outward unit normals of the edges. Each lane (core/math/lanes.hpp) has its own polygon. If it
/// has fewer than `count` edges, its unused planes are far from everything.
template <class T>
struct Planes {
  int count = 0;
  Vec2<T> normal[kMaxVertices];
  T offset[kMaxVertices] = {};  // [m]
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
template <class T>
class SignedDistance {
 public:
  static_assert(kMaxVertices <= static_cast<std::size_t>(kMaxExponentials));

  /// `distances` and `top` are what plane_distances() writes and returns for x. `alpha` is α.
  SignedDistance(const Planes<T>& planes, double alpha, const T* distances, const T& top)
      : planes_(planes), alpha_(alpha) {
    T exponent[kMaxVertices];
    for (int k = 0; k < planes.count; ++k) {
      exponent[k] = T(alpha) * (distances[k] - top);
      weight_[k] = greater(exponent[k], T(kNothing));
    }
    exponentials(weight_, planes.count);
    T sum(0.0);
    for (int k = 0; k < planes.count; ++k) {
      weight_[k] = select(exponent[k] > T(kNothing), weight_[k], T(0.0));
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

  /// Returns ∇²d [1/m].
  Mat2<T> hessian() const {
    return moments([](const T& weight, const Vec2<T>&) { return weight; }, alpha_);
  }
  /// Returns ∇³d contracted with `a`, the derivative of ∇²d along a. Unit: [1/m²] times that of a.
  Mat2<T> third(const Vec2<T>& a) const {
    return moments([&a](const T& weight, const Vec2<T>& m) { return weight * m.dot(a); },
                   alpha_ * alpha_);
  }

  T value;           // d [m]
  Vec2<T> gradient;  // ∇d, |∇d| ≤ 1

 private:
  static constexpr double kNothing = -100.0;  // weights of at most e^-100 are set to zero

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
};

/// Returns the smoothed signed distance of `x` to one polygon. `alpha` is α.
inline SignedDistance<double> signed_distance(const HalfPlanes& planes, double alpha,
                                              const Vector2d& x) {
  double distances[kMaxVertices];
  const double top = plane_distances(planes, x, distances);
  return {planes, alpha, distances, top};
}

}  // namespace rtg

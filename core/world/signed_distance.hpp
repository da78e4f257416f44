#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/math/dual.hpp"
#include "core/world/polygon.hpp"

namespace rtg {

template <class S>
using Vec2 = Eigen::Matrix<S, 2, 1>;
template <class S>
using Mat2 = Eigen::Matrix<S, 2, 2>;

/// A convex polygon as the intersection of its half planes n_k·x ≤ b_k, n_k the outward unit
/// normals, in the body frame.
struct HalfPlanes {
  int count = 0;
  Vector2d normal[kMaxVertices];
  double offset[kMaxVertices] = {};  // [m]
};

HalfPlanes half_planes(const Polygon& shape);

/// Largest half-plane distance of a point, max_k (n_k·x - b_k) ≤ d(x).
inline double mitred_distance(const HalfPlanes& planes, const Vector2d& x) {
  double top = -INFINITY;
  for (int k = 0; k < planes.count; ++k)
    top = std::max(top, planes.normal[k].dot(x) - planes.offset[k]);
  return top;
}

/// Smoothed signed distance of a point x to a convex polygon and its derivatives,
///
///   d(x) = 1/α ln Σ_k exp(α (n_k·x - b_k)),   w = softmax(α (n_k·x - b_k)),
///   ∇d = n̄ = Σ w n,   ∇²d = α (Σ w n nᵀ - n̄ n̄ᵀ),   ∇³d = α² Σ w (n - n̄)^⊗3,
///
/// all in the polygon's frame. Exact on faces; right angles are cut by at most
/// √2 ln 2/α. S is double or Dual.
template <class S>
class SignedDistance {
 public:
  SignedDistance(const HalfPlanes& planes, double alpha, const Vec2<S>& x)
      : planes_(planes), alpha_(alpha) {
    S top(-INFINITY);
    for (int k = 0; k < planes.count; ++k) {
      weight_[k] = normal(k).dot(x) - S(planes.offset[k]);
      if (weight_[k] > top) top = weight_[k];
    }
    using std::exp, std::log;
    S sum(0.0);
    for (int k = 0; k < planes.count; ++k) {
      weight_[k] = exp(S(alpha) * (weight_[k] - top));
      sum += weight_[k];
    }
    gradient.setZero();
    for (int k = 0; k < planes.count; ++k) {
      weight_[k] /= sum;
      gradient += normal(k) * weight_[k];
    }
    value = top + log(sum) / S(alpha);
  }

  /// ∇²d [1/m].
  Mat2<S> hessian() const {
    Mat2<S> sum = Mat2<S>::Zero();
    for (int k = 0; k < planes_.count; ++k) {
      const Vec2<S> m = normal(k) - gradient;
      sum += (m * m.transpose()) * (S(alpha_) * weight_[k]);
    }
    return sum;
  }

  /// ∇³d contracted with `a`: the derivative of ∇²d along a, [1/m²] times the unit of a.
  Mat2<S> third(const Vec2<S>& a) const {
    Mat2<S> sum = Mat2<S>::Zero();
    for (int k = 0; k < planes_.count; ++k) {
      const Vec2<S> m = normal(k) - gradient;
      sum += (m * m.transpose()) * (S(alpha_ * alpha_) * weight_[k] * m.dot(a));
    }
    return sum;
  }

  S value;           // d [m]
  Vec2<S> gradient;  // ∇d, |∇d| ≤ 1

 private:
  Vec2<S> normal(int k) const { return planes_.normal[k].template cast<S>(); }

  const HalfPlanes& planes_;
  double alpha_;
  S weight_[kMaxVertices];
};

}  // namespace rtg

#pragma once

#include <Eigen/Core>
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
    S top = height(0, x);
    for (int k = 1; k < planes.count; ++k) {
      const S h = height(k, x);
      if (h > top) top = h;
    }
    using std::exp, std::log;
    S sum(0.0);
    for (int k = 0; k < planes.count; ++k) {
      weight_[k] = exp(S(alpha) * (height(k, x) - top));
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
  S height(int k, const Vec2<S>& x) const { return normal(k).dot(x) - S(planes_.offset[k]); }
  Vec2<S> normal(int k) const { return planes_.normal[k].template cast<S>(); }

  const HalfPlanes& planes_;
  double alpha_;
  S weight_[kMaxVertices];
};

}  // namespace rtg

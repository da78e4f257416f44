#pragma once

#include <Eigen/Core>
#include <cmath>

#include "core/world/signed_distance.hpp"

namespace rtg {

template <class S>
using Vec6 = Eigen::Matrix<S, 6, 1>;
template <class S>
using Mat6 = Eigen::Matrix<S, 6, 6>;

/// E = [0 -1; 1 0], the turn by +90°.
template <class S>
Vec2<S> turned(const Vec2<S>& a) {
  return {-a.y(), a.x()};
}

/// A vertex v of body i seen from body j, as a function of both poses q = (p_i, p_j):
///
///   x(q) = R(θ_j)ᵀ (R(θ_i) v + t_i - t_j)
///
/// with first derivatives `jacobian` (∂x/∂q) and second derivatives contracted with a w. Distances
/// and slips are functions of x alone, hence invariant under a rigid motion of the scene.
template <class S>
struct LocalPoint {
  Vec2<S> x;                        // [m]
  Eigen::Matrix<S, 2, 6> jacobian;  // columns t_i, θ_i, t_j, θ_j

  LocalPoint(const Vector2d& vertex, const Vec6<S>& q) {
    using std::cos, std::sin;
    const S c = cos(q[5]), s = sin(q[5]);
    to_frame_ << c, s, -s, c;
    const S ci = cos(q[2] - q[5]), si = sin(q[2] - q[5]);
    arm_ = {ci * S(vertex.x()) - si * S(vertex.y()), si * S(vertex.x()) + ci * S(vertex.y())};
    x = arm_ + to_frame_ * Vec2<S>(q[0] - q[3], q[1] - q[4]);
    jacobian.template leftCols<2>() = to_frame_;
    jacobian.col(2) = turned(arm_);
    jacobian.template middleCols<2>(3) = -to_frame_;
    jacobian.col(5) = -turned(x);
  }

  /// Σ_m w_m ∇²x_m, symmetric 6×6.
  Mat6<S> hessian(const Vec2<S>& w) const {
    Mat6<S> H = Mat6<S>::Zero();
    H(2, 2) = -w.dot(arm_);
    H(2, 5) = H(5, 2) = w.dot(arm_);
    H(5, 5) = -w.dot(x);
    const Vec2<S> cross = to_frame_.transpose() * turned(w);  // -Rᵀ Eᵀ w = Rᵀ E w
    for (int m = 0; m < 2; ++m) {
      H(m, 5) = H(5, m) = cross[m];
      H(3 + m, 5) = H(5, 3 + m) = -cross[m];
    }
    return H;
  }

 private:
  Mat2<S> to_frame_;  // R(θ_j)ᵀ
  Vec2<S> arm_;       // R(θ_i - θ_j) v
};

}  // namespace rtg

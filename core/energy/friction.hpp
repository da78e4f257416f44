#pragma once

#include "core/energy/local_point.hpp"

namespace rtg {

template <class S>
using Vec12 = Eigen::Matrix<S, 12, 1>;
template <class S>
using Mat12 = Eigen::Matrix<S, 12, 12>;

/// Potential of lagged friction of one contact for unit μ_f λ, over z = (q₊, q): the poses of both
/// bodies after and before the sub-step,
///
///   φ(u) = √(u² + ε²) - ε,   u = t(x)·(x₊ - x),   t(x) = E ∇d(x),
///
/// x, x₊ the vertex in the other body's frame before and after, u its slip along the surface. Its
/// gradient with respect to q₊ times μ_f λ is the friction force; λ is the normal force before the
/// sub-step. |∇d| < 1 at rounded corners scales slip and force alike, so |force| → μ_f λ |∇d|, μ_f
/// times the normal force there.
///
/// Departs from the paper: its P_∥ carries the barrier weight twice and lacks Δt.
template <class S>
struct Friction {
  S value;  // φ [m]
  Vec12<S> gradient;
  Mat12<S> hessian;
};

/// φ(u) as a function of q₊ alone, which is all that a forward step needs. Refers to the point
/// after the sub-step.
template <class S>
class Slip {
 public:
  Slip(const HalfPlanes& planes, double alpha, double scale, const LocalPoint<S>& next,
       const LocalPoint<S>& now)
      : distance(planes, alpha, now.x), tangent(turned(distance.gradient)), next_(next) {
    using std::sqrt;
    const Vec2<S> moved = next.x - now.x;
    way = {moved.y(), -moved.x()};  // Eᵀ (x₊ - x), so u = ∇d·way
    const S u = distance.gradient.dot(way), e2(scale * scale);
    const S root = sqrt(u * u + e2);
    value = root - S(scale);
    slope = u / root;
    bend = e2 / (root * root * root);
  }

  Vec6<S> gradient() const { return next_.jacobian.transpose() * (tangent * slope); }
  Mat6<S> hessian() const {
    const Vec6<S> g = next_.jacobian.transpose() * tangent;
    return g * g.transpose() * bend + next_.hessian(tangent) * slope;
  }

  SignedDistance<S> distance;  // of the point before
  Vec2<S> tangent;             // t
  Vec2<S> way;
  S value, slope, bend;  // φ, φ', φ''

 private:
  const LocalPoint<S>& next_;
};

template <class S>
Friction<S> friction(const HalfPlanes& planes, double alpha, double slip, const LocalPoint<S>& next,
                     const LocalPoint<S>& now) {
  const Slip<S> s(planes, alpha, slip, next, now);
  const Mat2<S> bent = s.distance.hessian();
  Mat2<S> tangent_slope;  // ∂t/∂x = E ∇²d
  tangent_slope << -bent(1, 0), -bent(1, 1), bent(0, 0), bent(0, 1);
  const Vec2<S> u_x = bent * s.way - s.tangent;
  const Mat2<S> u_xx = s.distance.third(s.way) - tangent_slope - tangent_slope.transpose();

  Friction<S> f;
  f.value = s.value;
  Vec12<S> g;
  g.template head<6>() = next.jacobian.transpose() * s.tangent;
  g.template tail<6>() = now.jacobian.transpose() * u_x;
  f.gradient = g * s.slope;
  f.hessian = (g * g.transpose()) * s.bend;
  f.hessian.template topLeftCorner<6, 6>() += next.hessian(s.tangent) * s.slope;
  const Mat6<S> cross = next.jacobian.transpose() * tangent_slope * now.jacobian * s.slope;
  f.hessian.template topRightCorner<6, 6>() += cross;
  f.hessian.template bottomLeftCorner<6, 6>() += cross.transpose();
  f.hessian.template bottomRightCorner<6, 6>() +=
      (now.jacobian.transpose() * u_xx * now.jacobian + now.hessian(u_x)) * s.slope;
  return f;
}

}  // namespace rtg

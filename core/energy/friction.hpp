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

template <class S>
Friction<S> friction(const HalfPlanes& planes, double alpha, double slip, const LocalPoint<S>& next,
                     const LocalPoint<S>& now) {
  using std::sqrt;
  const SignedDistance<S> d(planes, alpha, now.x);
  const Vec2<S> t = turned(d.gradient);
  const Vec2<S> moved = next.x - now.x;
  const Vec2<S> a(moved.y(), -moved.x());  // Eᵀ (x₊ - x), so u = ∇d·a
  const S u = d.gradient.dot(a);
  const S root = sqrt(u * u + S(slip * slip));
  const S slope = u / root, bend = S(slip * slip) / (root * root * root);  // φ', φ''

  const Mat2<S> bent = d.hessian();
  Mat2<S> tangent_slope;  // ∂t/∂x = E ∇²d
  tangent_slope << -bent(1, 0), -bent(1, 1), bent(0, 0), bent(0, 1);
  const Vec2<S> u_x = bent * a - t;
  const Mat2<S> u_xx = d.third(a) - tangent_slope - tangent_slope.transpose();

  Vec12<S> g;
  g.template head<6>() = next.jacobian.transpose() * t;
  g.template tail<6>() = now.jacobian.transpose() * u_x;
  Friction<S> f;
  f.value = root - S(slip);
  f.gradient = g * slope;
  f.hessian = (g * g.transpose()) * bend;
  f.hessian.template topLeftCorner<6, 6>() += next.hessian(t) * slope;
  const Mat6<S> cross = next.jacobian.transpose() * tangent_slope * now.jacobian * slope;
  f.hessian.template topRightCorner<6, 6>() += cross;
  f.hessian.template bottomLeftCorner<6, 6>() += cross.transpose();
  f.hessian.template bottomRightCorner<6, 6>() +=
      (now.jacobian.transpose() * u_xx * now.jacobian + now.hessian(u_x)) * slope;
  return f;
}

}  // namespace rtg

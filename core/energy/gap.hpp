#pragma once

#include "core/energy/local_point.hpp"

namespace rtg {

/// Gap g(q) = d_j(x(q)) - d₀ of a vertex of body i to body j, q = (p_i, p_j), with gradient [6] and
/// Hessian [6×6]. With S = Dual seeded along y, the dual parts are y·∇ of each of the three.
template <class S>
struct Gap {
  S value;  // [m]
  Vec6<S> gradient;
  Mat6<S> hessian;
};

/// The value alone.
template <class S>
S gap_value(const HalfPlanes& planes, double alpha, double skin, const LocalPoint<S>& point) {
  return SignedDistance<S>(planes, alpha, point.x).value - S(skin);
}

/// Value and gradient alone.
template <class S>
struct GapSlope {
  S value;
  Vec6<S> gradient;
};

template <class S>
GapSlope<S> gap_slope(const HalfPlanes& planes, double alpha, double skin,
                      const LocalPoint<S>& point) {
  const SignedDistance<S> d(planes, alpha, point.x);
  return {d.value - S(skin), point.jacobian.transpose() * d.gradient};
}

template <class S>
Gap<S> gap(const HalfPlanes& planes, double alpha, double skin, const LocalPoint<S>& point) {
  const SignedDistance<S> d(planes, alpha, point.x);
  Gap<S> g;
  g.value = d.value - S(skin);
  g.gradient = point.jacobian.transpose() * d.gradient;
  g.hessian = point.jacobian.transpose() * d.hessian() * point.jacobian + point.hessian(d.gradient);
  return g;
}

}  // namespace rtg

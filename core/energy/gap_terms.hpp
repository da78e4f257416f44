#pragma once

#include "core/energy/contact_point.hpp"
#include "core/world/signed_distance.hpp"

namespace rtg::energy {

/// Gradient and Hessian of a contact's gap g = d(x) - d₀ in the coordinates u of its pair
/// (PairFrame).
template <class T>
struct GapTerms {
  Vec4<T> gradient;
  Mat4<T> hessian;

  GapTerms(const SignedDistance<T>& d, const Mat2<T>& D, const ContactPoint<T>& p)
      : gradient(p.pulled(d.gradient)), hessian(p.pulled(D, p)) {
    p.add_curvature(d.gradient, hessian);
  }
};

/// Rates of GapTerms along a motion y of the pair, including the rotation of its frame. In the
/// notation of PairFrame they are ġ + Ωᵀ g for the gradient and Ḣ + Ωᵀ H + H Ω for the Hessian.
template <class T>
struct GapRates {
  Vec4<T> gradient;
  Mat4<T> hessian;

  GapRates(const SignedDistance<T>& d, const Mat2<T>& D, const ContactPoint<T>& p,
           const GapTerms<T>& g, const Vec4<T>& y) {
    const ContactPoint<T> rate = p.along(y);
    const Vec2<T> n = product(D, rate.x);
    gradient = p.pulled(n) + rate.pulled_rate(d.gradient) + frame_turn(y[3], g.gradient);
    const Mat4<T> moving = rate.pulled_rate(D, p) + row_turn(y[3], g.hessian);
    hessian = p.pulled(d.third(rate.x), p) + moving + moving.transpose();
    p.add_curvature(n, hessian);
    rate.add_curvature_rate(d.gradient, hessian);
  }
};

}  // namespace rtg::energy

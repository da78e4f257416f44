#pragma once

#include "core/energy/contact_point.hpp"
#include "core/world/signed_distance.hpp"

namespace rtg::energy {

/// Derivatives of the gap g = d(x) - d₀ of a contact in the pair's coordinates.
template <class T>
struct GapTerms {
  Vec4<T> gradient;
  Mat4<T> hessian;

  GapTerms(const SignedDistance<T>& d, const Mat2<T>& D, const ContactPoint<T>& p)
      : gradient(p.pulled(d.gradient)), hessian(p.pulled(D, p)) {
    p.add_curvature(d.gradient, hessian);
  }
};

/// The derivatives of GapTerms along a motion y, with the turn of the frame: y·∇ of the gradient
/// and of the Hessian in q.
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

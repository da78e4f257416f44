#pragma once

#include "core/energy/contact_point.hpp"

namespace rtg::energy {

/// Friction potential φ of one contact over a sub-step, per unit of μ_f λ, and its derivatives. The
/// friction is lagged: λ is the normal force before the sub-step. With the slip u of the contact,
///
///   φ(u) = √(u² + ε²) - ε,   u = t·(x₊ - x) - (roll₊ - roll),   t = E ∇d(x).
///
/// In derivatives of φ, u₊ and u denote the coordinates of the pair (PairFrame) instead: after and
/// before the sub-step.
///
/// Departs from the paper: printed, P_∥ has the barrier's weight μ twice and divides the slip by
/// Δt. Here λ has μ once, and a slip costs the same however many sub-steps it takes. And |u| is
/// smoothed by ε, 1/8 of the robot's way in a sub-step: with 1/400 the SQP takes 1.2 to 1.7 times
/// as many iterations.
template <class T>
struct SlipTerms {
  Vec2<T> tangent;               // t = ∂u/∂x₊
  Vec2<T> rotated_displacement;  // Eᵀ (x₊ - x); t·(x₊ - x) = ∇d·rotated_displacement
  T root, slope, bend;           // √(u² + ε²), φ', φ''
  T slip;                        // u
  Vec4<T> ahead;                 // ∂u/∂u₊ = X₊ᵀ t - ∂roll₊/∂u₊

  /// `normal` is ∇d(x), `next` the point after the sub-step, `x` and `roll` those of the point
  /// before it, `scale` ε.
  SlipTerms(const Vec2<T>& normal, const ContactPoint<T>& next, const Vec2<T>& x, const T& roll,
            double scale)
      : tangent(turned(normal)) {
    const Vec2<T> moved = next.x - x;
    rotated_displacement = {moved.y(), -moved.x()};
    slip = normal.dot(rotated_displacement) - (next.roll - roll);
    const T e2(scale * scale);
    root = rtg::root(slip * slip + e2);
    const T inverse = T(1.0) / root;
    slope = slip * inverse;
    bend = e2 * inverse * inverse * inverse;
    ahead = next.pulled(tangent) - next.roll_gradient();
  }

  T value(double scale) const { return root - T(scale); }
  /// Returns ∂φ/∂u₊.
  Vec4<T> gradient() const { return ahead * slope; }
  /// Returns ∂²φ/∂u₊².
  Mat4<T> hessian(const ContactPoint<T>& next) const {
    Mat4<T> H = Mat4<T>::Constant(T(0.0));
    next.add_curvature(tangent, H);
    H = H * slope;
    H += (ahead * bend) * ahead.transpose();
    return H;
  }
};

/// Geometry of a slipping contact: its point after and before a sub-step. d and its derivatives are
/// taken at the point before.
template <class T>
struct SlipGeometry {
  const SignedDistance<T>& d;  // at the point before
  const Mat2<T>& D;            // ∇²d
  const ContactPoint<T>&after, &before;
};

/// Mixed second derivatives of φ, and the rates of its gradient and Hessian along a motion y of the
/// poses after the sub-step (x₊ moves, x stays). The rates include the rotation of the frame of u₊
/// (PairFrame).
template <class T>
class SlipRates {
 public:
  /// `hessian` is ∂²φ/∂u₊².
  SlipRates(const SlipTerms<T>& s, const SlipGeometry<T>& at, const Mat4<T>& hessian,
            const Vec4<T>& y)
      : s_(s),
        at_(at),
        rate_(at.after.along(y)),
        rotated_displacement_rate_(rate_.x.y(), -rate_.x.x()) {
    tangent_slope_ << -at.D(1, 0), -at.D(1, 1), at.D(0, 0), at.D(0, 1);
    u_x_ = product(at.D, s.rotated_displacement) - s.tangent;
    const T slip = s.tangent.dot(rate_.x) - rate_.roll;
    slope_ = s.bend * slip;
    bend_ = T(-3.0) * s.slip * s.bend * slip / (s.root * s.root);
    ahead_ = rate_.pulled_rate(s.tangent);
    behind_ = at.before.pulled(u_x_) + at.before.roll_gradient();
    behind_rate_ = at.before.pulled(product(at.D, rotated_displacement_rate_));
    next = s.ahead * slope_ + ahead_ * s.slope + frame_turn(y[3], s.gradient());
    now = behind_ * slope_ + behind_rate_ * s.slope;
    set_next_next(row_turn(y[3], hessian));
    set_mixed(y[3]);
    set_now_now();
  }

  Mat4<T> cross;                         // ∂²φ/∂u₊∂u
  Vec4<T> next, now;                     // y·∇₊ of ∂φ/∂u₊, ∂φ/∂u
  Mat4<T> next_next, next_now, now_now;  // y·∇₊ of ∂²φ/∂u₊², ∂²φ/∂u₊∂u, ∂²φ/∂u²

 private:
  void set_next_next(const Mat4<T>& turn) {
    const Mat4<T> half = (ahead_ * s_.bend) * s_.ahead.transpose() + turn;
    Mat4<T> bent = Mat4<T>::Constant(T(0.0)), bent_rate = bent;
    at_.after.add_curvature(s_.tangent, bent);
    rate_.add_curvature_rate(s_.tangent, bent_rate);
    next_next = bent * slope_ + bent_rate * s_.slope;
    next_next += (s_.ahead * bend_) * s_.ahead.transpose();
    next_next += half;
    next_next += half.transpose();
  }

  void set_mixed(const T& turn) {
    const Mat4<T> mixed = at_.after.pulled(tangent_slope_, at_.before);
    cross = (s_.ahead * s_.bend) * behind_.transpose() + mixed * s_.slope;
    const Mat4<T> mixed_rate = rate_.pulled_rate(tangent_slope_, at_.before);
    next_now = (s_.ahead * bend_ + ahead_ * s_.bend) * behind_.transpose() +
               (s_.ahead * s_.bend) * behind_rate_.transpose() + mixed * slope_ +
               mixed_rate * s_.slope + row_turn(turn, cross);
  }

  void set_now_now() {
    Mat2<T> u_xx = at_.d.third(s_.rotated_displacement);
    u_xx -= tangent_slope_;
    u_xx -= tangent_slope_.transpose();
    Mat4<T> own = at_.before.pulled(u_xx, at_.before);
    at_.before.add_curvature(u_x_, own);
    Mat4<T> own_rate = at_.before.pulled(at_.d.third(rotated_displacement_rate_), at_.before);
    at_.before.add_curvature(product(at_.D, rotated_displacement_rate_), own_rate);
    const Mat4<T> half = (behind_rate_ * s_.bend) * behind_.transpose();
    now_now = (behind_ * bend_) * behind_.transpose() + half + half.transpose() + own * slope_ +
              own_rate * s_.slope;
  }

  const SlipTerms<T>& s_;
  const SlipGeometry<T>& at_;
  ContactPoint<T> rate_;               // (ẋ₊, ȧ₊)
  Vec2<T> rotated_displacement_rate_;  // rate of Eᵀ (x₊ - x)
  Mat2<T> tangent_slope_;              // ∂t/∂x = E D
  Vec2<T> u_x_;                        // ∂u/∂x
  T slope_, bend_;                     // rates of φ', φ''
  Vec4<T> ahead_;                      // rate of X₊ᵀ t
  Vec4<T> behind_;                     // Xᵀ ∂u/∂x + ∂roll/∂u
  Vec4<T> behind_rate_;
};

}  // namespace rtg::energy

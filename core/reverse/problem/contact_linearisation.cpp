#include "core/reverse/problem/contact_linearisation.hpp"

namespace rtg::reverse {
namespace {

template <class T>
Vec4<T> nothing() {
  return Vec4<T>::Constant(T(0.0));
}

}  // namespace

template <class T>
ContactLinearisation<T>::ContactLinearisation(const ProblemLanes<T>& problem,
                                              const Trajectory<T>& x, const Curvature<T>& curvature,
                                              int level, int pair)
    : scene_(problem.energy),
      curvature_(curvature),
      pair_(pair),
      first_(level == 0),
      last_(level == problem.sub_steps),
      poses_fixed_(last_ && problem.fixed_end()),
      forces_(x.forces[level].data() + energy::contact_of(pair, 0)),
      close_(scene_.near(pair, x.p[level])),
      here_(scene_.frame(pair, x.p[level])),
      ahead_(scene_.frame(pair, x.p[last_ ? level : level + 1])),
      y_(first_ ? nothing<T>() : pushed(scene_, pair, here_, x.multipliers[level].data())),
      y_next_(last_ ? nothing<T>()
                    : pushed(scene_, pair, ahead_, x.multipliers[level + 1].data())) {
  Mask<T> acts = close_;
  for (int v = 0; v < scene_.corners(pair); ++v) acts = acts || forces_[v] != T(0.0);
  relevant_ = any(acts);
}

template <class T>
bool ContactLinearisation<T>::add(int vertex, Eliminated<T>& eliminated) {
  eliminated = {};
  const energy::VertexContact<T> contact(scene_, pair_, vertex, here_, close_);
  const T force = forces_[vertex];
  const Mask<T> acts = contact.within || force != T(0.0);
  if (!any(acts)) return false;
  const SignedDistance<T> d = contact.distance();
  const Mat2<T> D = d.hessian();
  const energy::GapTerms<T> gap(d, D, contact.point);
  const T g = contact.gap(d, acts);
  const T r = first_ ? g + T(scene_.barrier().start_spare()) : g, inverse = T(1.0) / r;
  const energy::Barrier::Window<T> window = scene_.barrier().window(g);
  const T weight = select(acts, T(scene_.barrier().weight), T(0.0));
  const T s = force - weight * window.d1;
  eliminated.a = (weight * window.w - force * r) * inverse;
  if (!poses_fixed_) eliminated.b = gap.gradient * (-s * inverse);
  Contact c{contact, d, D, gap, g, r, force, eliminated.b, eliminated.a};
  if (first_)
    add_start_barrier(c);
  else
    add_normal_force(c);
  if (!last_) add_friction(c, scene_.point(pair_, vertex, ahead_));
  add_complementarity(c, s, weight * window.d2);
  return true;
}

/// Adds the barrier b(g(p_0)) of the objective.
template <class T>
void ContactLinearisation<T>::add_start_barrier(const Contact& c) {
  const energy::Barrier& barrier = scene_.barrier();
  const T pressure = select(c.geometry.within, barrier.force(c.g), T(0.0));
  const T stiffness = select(c.geometry.within, barrier.force_slope(c.g), T(0.0));
  own.gradient -= c.gap.gradient * pressure;
  own.Q -= (c.gap.gradient * stiffness) * c.gap.gradient.transpose();
  own.Q -= c.gap.hessian * (curvature_.start * pressure);
}

/// Adds the normal force, -λ ∇g(p_k) in Φ_k.
template <class T>
void ContactLinearisation<T>::add_normal_force(Contact& c) {
  const energy::GapRates<T> rates(c.d, c.D, c.geometry.point, c.gap, y_);
  own.E -= c.gap.hessian * c.force;
  own.E -= c.gap.gradient * c.b.transpose();
  own.e -= c.gap.gradient * c.a;
  own.residual -= c.gap.gradient * c.force;
  own.gradient -= rates.gradient * c.force;
  own.Q -= rates.hessian * (curvature_.lagrangian * c.force);
  c.now -= rates.gradient;
  c.force_gradient = c.force_gradient - c.gap.gradient.dot(y_);
}

/// Adds the friction, μ_f λ ∂φ/∂q₊ in Φ_{k+1}.
template <class T>
void ContactLinearisation<T>::add_friction(Contact& c, const energy::ContactPoint<T>& after) {
  const energy::SlipTerms<T> slip(c.d.gradient, after, c.geometry.point.x, c.geometry.point.roll,
                                  scene_.slip());
  const Mat4<T> hessian = slip.hessian(after);
  const energy::SlipGeometry<T> at{c.d, c.D, after, c.geometry.point};
  const energy::SlipRates<T> rates(slip, at, hessian, y_next_);
  const T mu = scene_.friction(pair_), load = mu * c.force, bent = curvature_.lagrangian * load;
  const Vec4<T> drag = slip.gradient() * mu;
  next.E += hessian * load;
  next.e += drag * c.a;
  next.residual += drag * c.force;
  next.gradient += rates.next * load;
  own.gradient += rates.now * load;
  F += rates.cross * load;
  F += drag * c.b.transpose();
  next.Q += rates.next_next * bent;
  own.Q += rates.now_now * bent;
  N += rates.next_now * bent;
  const Vec4<T> by_force = rates.next * (curvature_.lagrangian * mu);  // ∂²L/∂λ∂p_{k+1}
  N += by_force * c.b.transpose();
  next.q += by_force * c.a;
  c.now += rates.now * mu;
  c.force_gradient = c.force_gradient + drag.dot(y_next_);
}

/// Eliminates the force and the multiplier of its complementarity row. `s` is the slope λ - μ̃ w'
/// of the row, `bend` is μ̃ w''.
template <class T>
void ContactLinearisation<T>::add_complementarity(const Contact& c, const T& s, const T& bend) {
  own.gradient += c.b * c.force_gradient;
  const T z = -c.force_gradient / c.r * curvature_.lagrangian;
  own.Q += c.gap.hessian * (z * s);
  own.Q -= (c.gap.gradient * (z * bend)) * c.gap.gradient.transpose();
  const Vec4<T> now = c.now * curvature_.lagrangian + c.gap.gradient * z;
  const T proximal = T(kForceProximal) * curvature_.proximal;
  const Mat4<T> half = (now + c.b * (T(0.5) * proximal)) * c.b.transpose();
  own.Q += half;
  own.Q += half.transpose();
  own.q += (now + c.b * proximal) * c.a;
}

template class ContactLinearisation<double>;
template class ContactLinearisation<Lanes>;

}  // namespace rtg::reverse

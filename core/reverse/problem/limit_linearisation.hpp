#pragma once

#include "core/reverse/problem/contact_linearisation.hpp"

namespace rtg::reverse {

/// Terms of the Newton system, as factors of ∇v and of ∇v ∇vᵀ for a scalar v, the value of a joint
/// or the gap of its limit.
template <class T>
struct LimitTerms {
  T Q = T(0.0), E = Q;
  T gradient = Q, q = Q, e = Q, residual = Q;

  /// Adds `of`, whose scalar changes by `slope` times that of this object.
  void add(const LimitTerms& of, const T& slope) {
    Q = Q + of.Q * slope * slope;
    E = E + of.E * slope * slope;
    gradient = gradient + of.gradient * slope;
    q = q + of.q * slope;
    e = e + of.e * slope;
    residual = residual + of.residual * slope;
  }
};

/// Terms that one joint limit adds to the Newton system at one level (the poses after a sub-step).
/// The limit acts like a contact without friction whose gap g is linear in p
/// (ContactLinearisation). Vectors are stored as factors of ∇g, matrices as factors of ∇g ∇gᵀ.
template <class T>
struct LimitLinearisation {
  T a = T(0.0), b = T(0.0);  // Δλ = a + b ∇g·Δp
  LimitTerms<T> terms;

  /// Kind of level: the start, a fixed final state (kFixed), or any other (kWithin).
  enum class Level { kStart, kWithin, kFixed };
  /// Gap and force of the limit, and ∇g·y.
  struct State {
    T gap, force, gradient_dot_y;
  };

  LimitLinearisation(const State& at, const energy::Barrier& barrier, const Curvature<T>& curvature,
                     Level level) {
    const T inverse = T(1.0) / at.gap, mu(barrier.weight);
    const energy::Barrier::Window<T> window = barrier.window(at.gap);
    const T slope = at.force - mu * window.d1;
    a = (mu * window.w - at.force * at.gap) * inverse;
    if (level != Level::kFixed) b = -slope * inverse;
    T by_force(0.0);  // ∂L/∂λ without the complementarity row
    if (level == Level::kStart) {
      terms.gradient = -barrier.force(at.gap);
      terms.Q = -barrier.force_slope(at.gap);
    } else {
      terms.E = -b;
      terms.residual = -at.force;
      terms.e = -a;
      by_force = -at.gradient_dot_y;
    }
    terms.gradient = terms.gradient + b * by_force;
    const T z = -by_force * inverse * curvature.lagrangian;
    const T proximal = T(kForceProximal) * curvature.proximal;
    terms.Q = terms.Q - z * mu * window.d2 + T(2.0) * z * b + proximal * b * b;
    terms.q = (z + b * proximal) * a;
  }
};

}  // namespace rtg::reverse

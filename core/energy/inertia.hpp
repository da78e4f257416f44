#pragma once

#include "core/math/elementary_lanes.hpp"

namespace rtg::energy {

/// Inertia of one body over two sub-steps in units of k_D/Δt²: the term I of eq. (8),
///
///   ½ ι m |t₊ - 2t + t₋|² + ½ ι J (a - b)²                            (quadratic), or
///   ½ ι m |t₊ - 2t + t₋|² + ι J (3 - 2 cos a - 2 cos b + cos(a + b))  (periodic).
///
/// The weight is ι = 1/k_D. The successive rotations are b = θ - θ₋ and a = θ₊ - θ. The member
/// functions return the rotational part and its derivatives.
///
/// Departs from the paper: quadratic is the default, as in Damping. The periodic form, the paper's
/// area integral, also slows a free spin by b³ per sub-step.
template <class T>
struct Inertia {
  T mass;    // ι m [kg]
  T moment;  // ι J [kg m²]
  bool periodic = false;

  T turn_value(const T& a, const T& b) const {
    if (!periodic) return T(0.5) * moment * (a - b) * (a - b);
    return moment * (T(3.0) - T(2.0) * (turn_of(a).c + turn_of(b).c) + turn_of(a + b).c);
  }

  /// Derivative of the rotational part with respect to θ₊ (`value`), and the first and second
  /// derivatives of `value` with respect to a and b.
  struct Slope {
    T value, a, b, aa, ab, bb;
  };
  Slope turn_slope(const T& a, const T& b) const {
    const T none(0.0);
    if (!periodic) return {moment * (a - b), moment, -moment, none, none, none};
    const Turn<T> now = turn_of(a), both = turn_of(a + b);
    const T bend = moment * both.s;
    return {moment * (T(2.0) * now.s - both.s),
            moment * (T(2.0) * now.c - both.c),
            -moment * both.c,
            bend - T(2.0) * moment * now.s,
            bend,
            bend};
  }
};

}  // namespace rtg::energy

#pragma once

#include "core/math/elementary_lanes.hpp"

namespace rtg::energy {

/// Damping potential of one body over a sub-step in units of k_D/Δt²: the term I_D of eq. (8). With
/// the translation t₊ - t and the rotation a = θ₊ - θ it is
///
///   ½ m |t₊ - t|² + ½ J a²         (quadratic), or
///   ½ m |t₊ - t|² + J (1 - cos a)  (periodic: the area integral of eq. (8)).
///
/// The member functions return the rotational part and its derivatives with respect to a.
///
/// Departs from the paper: quadratic is the default, because the periodic form has spurious roots
/// at whole turns. In a prototype, not in this code, an SQP that was free to use them returned
/// turns of 50 to 10⁵ rad.
template <class T>
struct Damping {
  T mass;    // m [kg]
  T moment;  // J [kg m²]
  bool periodic = false;

  T turn_value(const T& a) const {
    return periodic ? moment * (T(1.0) - turn_of(a).c) : T(0.5) * moment * a * a;
  }
  T turn_slope(const T& a) const { return moment * (periodic ? turn_of(a).s : a); }
  T turn_curvature(const T& a) const { return periodic ? moment * turn_of(a).c : moment; }
  T turn_third(const T& a) const { return periodic ? -moment * turn_of(a).s : T(0.0); }
};

}  // namespace rtg::energy

#pragma once

#include <cmath>

namespace rtg {

/// Damping of one body over a sub-step in units of k_D/Δt²: the quasi-static stand-in for inertia,
///
///   ½ m |Δt|² + ½ J (Δθ)²     (quadratic), or
///   ½ m |Δt|² + J (1 - cos Δθ)  (periodic: the area integral of eq. (8)).
///
/// Departs from the paper: quadratic is the default, because the periodic form has spurious roots
/// at whole turns. The functions are those of the rotational part.
struct Damping {
  double mass = 0.0;    // m [kg]
  double moment = 0.0;  // J [kg m²]
  bool periodic = false;

  double turn_value(double a) const {
    return periodic ? moment * (1.0 - std::cos(a)) : 0.5 * moment * a * a;
  }
  double turn_slope(double a) const { return moment * (periodic ? std::sin(a) : a); }
  double turn_curvature(double a) const { return moment * (periodic ? std::cos(a) : 1.0); }
  double turn_third(double a) const { return periodic ? -moment * std::sin(a) : 0.0; }
};

}  // namespace rtg

#pragma once

#include <cmath>

#include "core/math/elementary_lanes.hpp"

namespace rtg::energy {

/// Barrier potential b of the gap g of a contact, with the weight μ̃ and the finite range ĝ:
///
///   b'(g) = -μ̃ w(y)/g,   y = g/ĝ,   w = (1 - y)³ for y < 1, 0 beyond,
///   b(g)  = μ̃ (-ln y - 3(1 - y) + 3/2 (1 - y²) - 1/3 (1 - y³)).
///
/// b is C³ at ĝ. The contact force λ = -b'(g) satisfies the relaxed complementarity λ g = μ̃ w(g).
///
/// `plain` selects the paper's barrier: w = 1.
///
/// Departs from the paper: its -μ̃ ln g has infinite range and moves bodies that nothing touches, by
/// 0.01 to 0.05 m in each push of the preset `paper`.
struct Barrier {
  double weight = 1.0;  // μ̃ [kg m²]
  double range = 1.0;   // ĝ [m]
  bool plain = false;

  /// Returns b(g) [kg m²]. The value is +∞ for g ≤ 0, so that a line search rejects the point.
  template <class T>
  T value(const T& g) const {
    const T open = select(g > T(0.0), g, T(1.0));
    T b;
    if (plain) {
      b = T(-weight) * logarithm(open);
    } else {
      const T y = lesser(open * T(1.0 / range), T(1.0));
      b = T(weight) * (-logarithm(y) - T(3.0) * (T(1.0) - y) + T(1.5) * (T(1.0) - y * y) -
                       (T(1.0) - y * y * y) * T(1.0 / 3.0));
    }
    return select(g > T(0.0), b, T(INFINITY));
  }

  /// Returns the spare gap g_s of the contact force at the start of a push, λ₀ = μ̃ w/(g + g_s) [m].
  /// It bounds that force by μ̃/g_s, with the defaults five times the largest force of the robot.
  ///
  /// Departs from the paper: it has g_s = 0. The force at the start appears in the friction of the
  /// first sub-step alone. Without a bound the reverse SQP narrows gaps at the start until friction
  /// holds bodies together, with forces of 1e3 to 1e5 times the robot's. It leaves 2.3 % of the
  /// problems of tests/bench/corpus_joints undecided then, with g_s = 0.002 ĝ 0.8 %.
  double start_spare() const { return plain ? 0.0 : kStartSpare * range; }

  /// The window w(g) and its first two derivatives with respect to g.
  template <class T>
  struct Window {
    T w, d1, d2;
  };
  template <class T>
  Window<T> window(const T& g) const {
    if (plain) return {T(1.0), T(0.0), T(0.0)};
    const T rest = greater((T(range) - g) * T(1.0 / range), T(0.0));
    return {rest * rest * rest, T(-3.0 / range) * rest * rest, T(6.0 / (range * range)) * rest};
  }

  /// Returns the contact force λ(g) = -b'(g) ≥ 0 [kg m], or μ̃ w/(g + spare).
  template <class T>
  T force(const T& g, double spare = 0.0) const {
    return T(weight) * window(g).w / (g + T(spare));
  }
  /// Returns λ'(g) [kg].
  template <class T>
  T force_slope(const T& g) const {
    const Window<T> w = window(g);
    return T(weight) * (w.d1 - w.w / g) / g;
  }

 private:
  static constexpr double kStartSpare = 2e-3;
};

}  // namespace rtg::energy

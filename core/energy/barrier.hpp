#pragma once

#include <cmath>

namespace rtg {

/// Contact barrier of weight μ̃ over the gap g,
///
///   b'(g) = -μ̃ w(y)/g,   y = g/ĝ,   w = (1 - y)³ for y < 1, 0 beyond,
///   b(g)  = μ̃ (-ln y - 3(1 - y) + 3/2 (1 - y²) - 1/3 (1 - y³)),
///
/// C³ at ĝ. The contact force λ = -b'(g) satisfies the relaxed complementarity λ g = μ̃ w(g).
///
/// Departs from the paper: its -μ̃ ln g has infinite range and moves bodies that nothing touches.
/// `plain` selects it: w = 1.
struct Barrier {
  double weight = 1.0;  // μ̃ [kg m²]
  double range = 1.0;   // ĝ [m]
  bool plain = false;

  bool acts(double g) const { return plain || g < range; }

  /// b(g) [kg m²]; +∞ for g ≤ 0, so that line searches back off.
  double value(double g) const {
    if (g <= 0.0) return INFINITY;
    if (plain) return -weight * std::log(g);
    if (g >= range) return 0.0;
    const double y = g / range;
    return weight *
           (-std::log(y) - 3.0 * (1.0 - y) + 1.5 * (1.0 - y * y) - (1.0 - y * y * y) / 3.0);
  }

  /// w and its derivatives with respect to g.
  struct Window {
    double w = 0.0, d1 = 0.0, d2 = 0.0;
  };
  Window window(double g) const {
    if (plain) return {1.0, 0.0, 0.0};
    if (g >= range) return {};
    const double rest = 1.0 - g / range;
    return {rest * rest * rest, -3.0 * rest * rest / range, 6.0 * rest / (range * range)};
  }

  /// λ(g) = -b'(g) ≥ 0 [kg m], and its derivative.
  double force(double g) const { return weight * window(g).w / g; }
  double force_slope(double g) const {
    const Window w = window(g);
    return weight * (w.d1 - w.w / g) / g;
  }
};

}  // namespace rtg

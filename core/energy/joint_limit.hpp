#pragma once

#include <algorithm>

#include "core/energy/articulation.hpp"

namespace rtg::energy {

/// A limit of a hinge, treated as a contact without friction: the tip of the child meets a stop.
/// With the reach r of the child from the pin, the gap is linear in the joint angle φ:
///
///   g = r (φ - φ_min) + g₀  or  r (φ_max - φ) + g₀.
///
/// g₀ is the distance that Box2D keeps between bodies in contact; the barrier's parameters are
/// matched to it. The offset d₀ of other contacts does not apply.
template <class T>
struct JointLimit {
  int parent, child;
  T gap;    // [m], kFar without a limit
  T slope;  // ∂g/∂θ_child = -∂g/∂θ_parent [m]

  JointLimit(const Hinge<T>& hinge, bool upper, const Placement<T>& at)
      : parent(hinge.parent), child(hinge.child), slope(upper ? -hinge.reach : hinge.reach) {
    const T angle = at.body(child)[2] - at.body(parent)[2];
    gap = lesser(slope * (angle - (upper ? hinge.upper : hinge.lower)) + T(kSlack), T(kFar));
    slope = select(gap < T(kFar), slope, T(0.0));
  }

  /// Adds f ∇g to `into` [3·movable]; `movable` is the number of movable bodies.
  void add_gradient(const T& f, int movable, T* into) const {
    into[3 * child + 2] = into[3 * child + 2] + f * slope;
    if (parent < movable) into[3 * parent + 2] = into[3 * parent + 2] - f * slope;
  }
  /// Returns ∇g·y, the rate of the gap along a motion `y` [3·movable].
  T along(const T* y, int movable) const {
    return slope * (parent < movable ? y[3 * child + 2] - y[3 * parent + 2] : y[3 * child + 2]);
  }
  /// Adds f ∇g ∇gᵀ to the lower half of a symmetric matrix.
  void add_hessian(const T& f, int movable, BlockMatrix<T>& into) const {
    const T square = f * slope * slope;
    const auto add = [&into](int i, int j, const T& x) {
      into.add(i, j, diagonal<T>(Vec3<T>(T(0.0), T(0.0), x)));
    };
    add(child, child, square);
    if (parent >= movable) return;
    add(parent, parent, square);
    add(std::max(child, parent), std::min(child, parent), -square);
  }

  static constexpr double kSlack = 0.02, kFar = 1e6;  // g₀ [m]
};

/// Calls f(index, limit) for each limit of each hinge. A hinge's lower limit comes before its upper
/// one.
template <class T, class F>
void for_each_limit(const Articulation<T>& articulation, const Placement<T>& at, F f) {
  int index = 0;
  for (const Hinge<T>& hinge : articulation.hinges())
    for (const bool upper : {false, true}) f(index++, JointLimit<T>(hinge, upper, at));
}

}  // namespace rtg::energy

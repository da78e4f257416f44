#pragma once

#include <algorithm>

#include "core/energy/articulation.hpp"

namespace rtg::energy {

/// A limit of a joint, treated as a contact without friction: the child meets a stop. Its gap is
/// linear in the joint's value v,
///
///   g = r (v - v_min) + g₀  or  r (v_max - v) + g₀,
///
/// where r is the reach of the child from the pin of a revolute joint, else 1. g₀ is the distance
/// that Box2D keeps between bodies in contact; the barrier's parameters are matched to it. The
/// offset d₀ of other contacts does not apply.
template <class T>
struct JointLimit {
  T gap;    // [m], kFar without a limit
  T slope;  // ∂g/∂v [m/rad] or 1, 0 without a limit

  JointLimit(const JointModel<T>& joint, bool upper, const T& value)
      : slope(upper ? -joint.reach : joint.reach) {
    gap = lesser(slope * (value - (upper ? joint.upper : joint.lower)) + T(kSlack), T(kFar));
    slope = select(gap < T(kFar), slope, T(0.0));
  }

  static constexpr double kSlack = 0.02, kFar = 1e6;  // g₀ [m]
};

/// Calls f(index, limit) for each limit of each joint. A joint's lower limit comes before its upper
/// one.
template <class T, class F>
void for_each_limit(const Articulation<T>& articulation, const Placement<T>& at, F f) {
  int index = 0;
  for (const JointModel<T>& joint : articulation.joints()) {
    const T value = value_of(joint, at);
    for (const bool upper : {false, true}) f(index++, JointLimit<T>(joint, upper, value));
  }
}

}  // namespace rtg::energy

#pragma once

#include "core/math/elementary.hpp"

namespace rtg::reverse {

/// The force with which a control c moves the robot, B tanh c, in Φ with a minus; eq. (8)'s P_E.
template <class T>
struct ControlForce {
  T value, slope, curvature;  // and its derivatives in c

  ControlForce(const T& bound, const T& control) {
    const T push = hyperbolic_tangent(control);
    value = bound * push;
    slope = bound * (T(1.0) - push * push);
    curvature = T(-2.0) * push * slope;
  }
};

}  // namespace rtg::reverse

#pragma once

#include "core/math/elementary_lanes.hpp"

namespace rtg::reverse {

/// The force B tanh c that a control c exerts on the robot, from P_E of eq. (8). It enters Φ with a
/// minus sign.
template <class T>
struct ControlForce {
  T value, slope, curvature;  // the force and its first and second derivatives in c

  ControlForce(const T& bound, const T& control) {
    const T push = hyperbolic_tangent(control);
    value = bound * push;
    slope = bound * (T(1.0) - push * push);
    curvature = T(-2.0) * push * slope;
  }
};

}  // namespace rtg::reverse

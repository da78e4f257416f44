#pragma once

#include "core/math/elementary.hpp"
#include "core/math/lanes.hpp"

namespace rtg {

Lanes exponential(const Lanes& x);
Lanes logarithm(const Lanes& x);
Lanes hyperbolic_tangent(const Lanes& x);
Turn<Lanes> turn_of(const Lanes& angle);

}  // namespace rtg

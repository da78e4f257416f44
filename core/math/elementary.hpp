#pragma once

#include "core/math/lanes.hpp"

namespace rtg {

/// Largest `count` that exponentials() accepts for Lanes.
inline constexpr int kMaxExponentials = 8;

/// Replaces each of the `count` numbers in `x` by its exponential. The Lanes version of each
/// function in this file agrees with the double version to a few units in the last place.
void exponentials(double* x, int count);
void exponentials(Lanes* x, int count);

template <class T>
struct Turn {
  T c, s;  // cos θ, sin θ
};
Turn<double> turn_of(double angle);
Turn<Lanes> turn_of(const Lanes& angle);

double hyperbolic_tangent(double x);
Lanes hyperbolic_tangent(const Lanes& x);
double logarithm(double x);
Lanes logarithm(const Lanes& x);

}  // namespace rtg

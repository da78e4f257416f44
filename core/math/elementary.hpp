#pragma once

#include "core/math/lanes.hpp"

namespace rtg {

/// Largest `count` of exponentials() of Lanes.
inline constexpr int kMostNumbers = 8;

/// Elementary functions. Those of Lanes agree with those of double to a few units in the last
/// place. exponentials() replaces each of `count` numbers x by e^x.
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

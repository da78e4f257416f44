#pragma once

#include "core/math/lanes.hpp"

namespace rtg {

inline constexpr int kMostNumbers = 8;

/// Elementary functions, of lanes to a few units in the last place of those of double; e^x in
/// place, for at most kMostNumbers.
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

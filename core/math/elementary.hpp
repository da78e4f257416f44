#pragma once

namespace rtg {

// Elementary functions that give the same bits for the same number on every processor. They consist
// of operations that round correctly; the functions of the C library round otherwise from processor
// to processor and from version to version. Errors are at most three units in the last place. A NaN
// gives a NaN. elementary_lanes.hpp has them for lanes, with the same bits.

/// e^x; zero below -708, infinite above 708.
double exponential(double x);

/// ln x; -∞ for zero and numbers below 2.3e-308, NaN for negative ones.
double logarithm(double x);

double hyperbolic_tangent(double x);

template <class T>
struct Turn {
  T c, s;  // cos θ, sin θ
};
/// `angle` is θ [rad]; NaN beyond ±1e9.
Turn<double> turn_of(double angle);

/// Returns the angle of the vector (x, y) from the x axis, in [-π, π]; 0 for the vector 0.
double angle_of(double x, double y);

}  // namespace rtg

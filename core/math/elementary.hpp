#pragma once

namespace rtg {

// Elementary functions that give the same bits for the same number on every processor, and the same
// for a number as for a lane (elementary_lanes.hpp): SLEEF's deterministic functions. Those of the
// C library round otherwise from processor to processor and from version to version. Errors are at
// most 3.5 units in the last place. A NaN gives a NaN.

double exponential(double x);

/// ln x; -∞ for zero, NaN for negative numbers.
double logarithm(double x);

double hyperbolic_tangent(double x);

template <class T>
struct Turn {
  T c, s;  // cos θ, sin θ
};
/// `angle` is θ [rad].
Turn<double> turn_of(double angle);

/// Returns the angle of the vector (x, y) from the x axis, in [-π, π]; 0 for the vector 0.
double angle_of(double x, double y);

}  // namespace rtg

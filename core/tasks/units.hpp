#pragma once

#include <cmath>

namespace rtg::tasks {

/// Units of a task in memory: those in which the robot has kRobotRadius and density 1. The
/// constants of solver, simulators, sampling and search are made for such a robot, so that a task
/// of any size and mass is the same to them.
struct Units {
  double length = 1.0;   // [m]
  double density = 1.0;  // [kg/m²]
  bool rounds = true;    // whether length_of() and density_of() round

  /// Returns a length given in metres, or a density in kg/m², in these units. It is rounded to
  /// 1e-10, so that equal tasks of different sizes get equal bits.
  double length_of(double metres) const { return on_grid(metres / length); }
  double density_of(double given) const { return on_grid(given / density); }

  /// Return one metre and one kilogram in these units.
  double metre() const { return 1.0 / length; }
  double kilogram() const { return 1.0 / (density * length * length); }

  /// Returns rounded(x), or x if these units do not round.
  double on_grid(double x) const { return rounds ? rounded(x) : x; }

  static double rounded(double x) { return std::round(1e10 * x) / 1e10; }

  bool operator==(const Units&) const = default;
};

inline constexpr double kRobotRadius = 0.8;

}  // namespace rtg::tasks

#include "core/energy/damping.hpp"

#include <gtest/gtest.h>

#include "core/world/scene.hpp"

namespace rtg::energy {
namespace {

const Damping<double> kQuadratic{1.7, 0.4, false}, kPeriodic{1.7, 0.4, true};

TEST(Damping, DerivativesMatchDifferences) {
  const double t = 1e-5;
  for (const Damping<double>& d : {kQuadratic, kPeriodic})
    for (const double a : {-2.5, -0.3, 0.0, 0.05, 1.4}) {
      EXPECT_NEAR(d.turn_slope(a), (d.turn_value(a + t) - d.turn_value(a - t)) / (2.0 * t), 1e-10);
      EXPECT_NEAR(d.turn_curvature(a), (d.turn_slope(a + t) - d.turn_slope(a - t)) / (2.0 * t),
                  1e-10);
      EXPECT_NEAR(d.turn_third(a), (d.turn_curvature(a + t) - d.turn_curvature(a - t)) / (2.0 * t),
                  1e-10);
    }
}

// Eq. (8): ∫ ρ/2 |X(v, p₊) - X(v, p)|² dv. The integrand is a quadratic of v, for which the
// two-point Gauss rule is exact.
TEST(Damping, PeriodicFormIsTheAreaIntegralOfSquaredDisplacement) {
  const double width = 1.3, height = 0.7, density = 1.9;
  const Mass mass = mass_of({"b", "box", box(width, height), density, 0.3, false});
  const Damping<double> damping{mass.mass, mass.moment, true};
  const Pose before{0.2, -0.4, 0.3}, after{0.5, 0.1, 1.2};
  double integral = 0.0;
  const double node = 0.5 / std::sqrt(3.0);
  for (const double x : {-node * width, node * width})
    for (const double y : {-node * height, node * height}) {
      const Vector2d moved = to_world(after, {x, y}) - to_world(before, {x, y});
      integral += 0.5 * density * moved.squaredNorm() * 0.25 * width * height;
    }
  const double shift = 0.5 * damping.mass * (after.position() - before.position()).squaredNorm();
  EXPECT_NEAR(shift + damping.turn_value(0.9), integral, 1e-14);
}

TEST(Damping, FormsAgreeForSmallTurns) {
  for (const double a : {0.1, 0.01})  // 1 - cos a = a²/2 - a⁴/24 + ...
    EXPECT_NEAR(kQuadratic.turn_value(a) - kPeriodic.turn_value(a), 0.4 * std::pow(a, 4) / 24.0,
                1e-3 * std::pow(a, 4) + 1e-17);
}

TEST(Damping, PeriodicFormForgetsWholeTurnsAndTheQuadraticOneDoesNot) {
  const double turn = 2.0 * std::acos(-1.0);
  EXPECT_NEAR(kPeriodic.turn_value(0.4 + turn), kPeriodic.turn_value(0.4), 1e-14);
  EXPECT_NEAR(kQuadratic.turn_slope(turn), 0.4 * turn, 1e-14);
}

}  // namespace
}  // namespace rtg::energy

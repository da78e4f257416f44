#include "core/energy/inertia.hpp"

#include <gtest/gtest.h>

#include "core/world/scene.hpp"

namespace rtg::energy {
namespace {

const Inertia<double> kQuadratic{1.7, 0.4, false}, kPeriodic{1.7, 0.4, true};
constexpr double kTurns[] = {-2.5, -0.3, 0.0, 0.05, 1.4};
constexpr double kStep = 1e-5;

/// Central difference of f at x.
template <class F>
double difference(F f, double x) {
  return (f(x + kStep) - f(x - kStep)) / (2.0 * kStep);
}

TEST(Inertia, DerivativesMatchDifferences) {
  for (const Inertia<double>& d : {kQuadratic, kPeriodic})
    for (const double a : kTurns)
      for (const double b : kTurns) {
        const auto s = d.turn_slope(a, b);
        const auto value = [&](double x) { return d.turn_value(x, b); };
        const auto after = [&](double x) { return d.turn_slope(x, b); };
        const auto before = [&](double x) { return d.turn_slope(a, x); };
        EXPECT_NEAR(s.value, difference(value, a), 1e-9);
        EXPECT_NEAR(s.a, difference([&](double x) { return after(x).value; }, a), 1e-9);
        EXPECT_NEAR(s.b, difference([&](double x) { return before(x).value; }, b), 1e-9);
        EXPECT_NEAR(s.aa, difference([&](double x) { return after(x).a; }, a), 1e-9);
        EXPECT_NEAR(s.ab, difference([&](double x) { return before(x).a; }, b), 1e-9);
        EXPECT_NEAR(s.bb, difference([&](double x) { return before(x).b; }, b), 1e-9);
      }
}

// Eq. (8): ∫ ρ/2 |X(v, p₊) - 2 X(v, p) + X(v, p₋)|² dv. The integrand is a quadratic of v, for
// which the two-point Gauss rule is exact.
TEST(Inertia, PeriodicFormIsTheAreaIntegralOfSquaredSecondDifferences) {
  const double width = 1.3, height = 0.7, density = 1.9;
  const Mass mass = mass_of({"b", "box", box(width, height), density, 0.3, false});
  const Inertia<double> inertia{mass.mass, mass.moment, true};
  const Pose before{0.2, -0.4, 0.3}, now{0.5, 0.1, 1.2}, after{0.9, 0.3, 1.6};
  double integral = 0.0;
  const double node = 0.5 / std::sqrt(3.0);
  for (const double x : {-node * width, node * width})
    for (const double y : {-node * height, node * height}) {
      const Vector2d bent =
          to_world(after, {x, y}) - 2.0 * to_world(now, {x, y}) + to_world(before, {x, y});
      integral += 0.5 * density * bent.squaredNorm() * 0.25 * width * height;
    }
  const Vector2d shift = after.position() - 2.0 * now.position() + before.position();
  EXPECT_NEAR(0.5 * mass.mass * shift.squaredNorm() + inertia.turn_value(0.4, 0.9), integral,
              1e-14);
}

// A free body keeps its turn; that of the periodic form falls by b³ (to third order).
TEST(Inertia, ASteadySpinIsFreeOfForceButForWhatThePeriodicFormTakes) {
  for (const double b : {0.05, 0.1}) {
    EXPECT_EQ(kQuadratic.turn_slope(b, b).value, 0.0);
    const double force = kPeriodic.turn_slope(b - b * b * b, b).value;
    EXPECT_NEAR(force, 0.0, 3.0 * 0.4 * std::pow(b, 5));
    EXPECT_GT(kPeriodic.turn_slope(b, b).value, 0.0);
  }
}

}  // namespace
}  // namespace rtg::energy

#include "core/math/elementary_lanes.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/math/hash.hpp"
#include "core/math/rng.hpp"

namespace rtg {
namespace {

constexpr int kTrials = 20000;

/// A number of either sign whose size is of any power of ten from 10^low to 10^high.
double of_any_size(double low, double high, Rng& rng) {
  return rng.uniform(-1.0, 1.0) * std::pow(10.0, rng.uniform(low, high));
}

/// Expects `value` within three and a half units in the last place of `expected`, as SLEEF
/// promises.
void expect_close(double value, long double expected, double of) {
  const auto rounded = static_cast<double>(expected);
  const double unit = std::nextafter(std::abs(rounded), INFINITY) - std::abs(rounded);
  EXPECT_LE(std::abs(static_cast<double>(value - expected)), 3.5 * unit) << "of " << of;
}

TEST(Elementary, ErrorsAreAtMostThreeAndAHalfUnitsInTheLastPlace) {
  Rng rng(1);
  for (int trial = 0; trial < kTrials; ++trial) {
    const double x = of_any_size(-9.0, 2.8, rng), angle = of_any_size(-9.0, 5.0, rng);
    const double size = std::abs(of_any_size(-300.0, 300.0, rng)), near = rng.uniform(0.3, 3.0);
    expect_close(exponential(x), std::exp(static_cast<long double>(x)), x);
    expect_close(hyperbolic_tangent(x), std::tanh(static_cast<long double>(x)), x);
    expect_close(logarithm(size), std::log(static_cast<long double>(size)), size);
    expect_close(logarithm(near), std::log(static_cast<long double>(near)), near);
    expect_close(turn_of(angle).c, std::cos(static_cast<long double>(angle)), angle);
    expect_close(turn_of(angle).s, std::sin(static_cast<long double>(angle)), angle);
    const double y = of_any_size(-3.0, 3.0, rng);
    expect_close(angle_of(x, y), std::atan2(static_cast<long double>(y), x), y / x);
  }
}

TEST(Elementary, LimitsAreThoseOfTheFunctions) {
  EXPECT_EQ(exponential(0.0), 1.0);
  EXPECT_EQ(exponential(-INFINITY), 0.0);
  EXPECT_EQ(exponential(INFINITY), INFINITY);
  EXPECT_EQ(logarithm(1.0), 0.0);
  EXPECT_EQ(logarithm(0.0), -INFINITY);
  EXPECT_EQ(logarithm(INFINITY), INFINITY);
  EXPECT_TRUE(std::isnan(logarithm(-1.0)));
  EXPECT_EQ(hyperbolic_tangent(INFINITY), 1.0);
  EXPECT_EQ(hyperbolic_tangent(-1e9), -1.0);
  EXPECT_TRUE(std::signbit(hyperbolic_tangent(-0.0)));
  EXPECT_EQ(turn_of(0.0).c, 1.0);
  EXPECT_EQ(turn_of(0.0).s, 0.0);
  EXPECT_TRUE(std::isnan(turn_of(INFINITY).c));
  for (const double x : {exponential(NAN), logarithm(NAN), hyperbolic_tangent(NAN), turn_of(NAN).s})
    EXPECT_TRUE(std::isnan(x));
  constexpr double kPi = std::numbers::pi;
  EXPECT_EQ(angle_of(0.0, 0.0), 0.0);
  EXPECT_EQ(angle_of(-2.0, 0.0), kPi);
  EXPECT_EQ(angle_of(0.0, 2.0), kPi / 2);
  EXPECT_EQ(angle_of(0.0, -2.0), -kPi / 2);
  EXPECT_EQ(angle_of(3.0, 3.0), kPi / 4);
  EXPECT_EQ(angle_of(-3.0, -3.0), -3 * kPi / 4);
}

// In another lane is a NaN.
TEST(Elementary, ALaneHasTheBitsOfDouble) {
  Rng rng(2);
  for (int trial = 0; trial < kTrials; ++trial) {
    const double x = of_any_size(-9.0, 2.8, rng);
    const int l = trial % kWidth<Lanes>;
    Lanes lanes(x);
    set_lane(lanes, (l + 1) % kWidth<Lanes>, NAN);
    EXPECT_EQ(lane(exponential(lanes), l), exponential(x));
    EXPECT_EQ(lane(hyperbolic_tangent(lanes), l), hyperbolic_tangent(x));
    EXPECT_EQ(lane(logarithm(magnitude(lanes)), l), logarithm(std::abs(x)));
    EXPECT_EQ(lane(turn_of(lanes).c, l), turn_of(x).c);
    EXPECT_EQ(lane(turn_of(lanes).s, l), turn_of(x).s);
    EXPECT_EQ(lane(plus_product(lanes, lanes, Lanes(x / 3)), l), plus_product(x, x, x / 3));
    EXPECT_EQ(lane(minus_product(lanes, lanes, Lanes(x / 3)), l), minus_product(x, x, x / 3));
  }
}

// The arguments are exact on every machine, and so are the values.
TEST(Elementary, ValuesAreTheSameBitsOnEveryMachine) {
  Rng rng(3);
  std::uint64_t digest = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const double x = rng.uniform(-50.0, 50.0), y = rng.uniform(-50.0, 50.0);
    for (const double value :
         {exponential(x), logarithm(std::abs(x)), hyperbolic_tangent(0.1 * x), turn_of(x).c,
          turn_of(x).s, angle_of(x, y), plus_product(y, x, y), minus_product(y, x, y)})
      digest = hashed(digest, std::bit_cast<std::uint64_t>(value));
  }
  EXPECT_EQ(digest, 7642052298388549095U);
}

TEST(Lanes, SelectsAndComparesLaneByLane) {
  Lanes a(1.0), b(2.0);
  set_lane(a, 0, 3.0);
  EXPECT_EQ(lane(greater(a, b), 0), 3.0);
  EXPECT_EQ(lane(lesser(a, b), 0), 2.0);
  EXPECT_TRUE(any(a > b));
  EXPECT_FALSE(any(a > Lanes(3.0)));
  EXPECT_EQ(lane(select(a > b, a, b), 0), 3.0);
  Lanes nan(NAN);
  EXPECT_FALSE(any(nan == nan));
}

}  // namespace
}  // namespace rtg

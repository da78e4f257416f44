#include "core/math/elementary.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "core/math/rng.hpp"

namespace rtg {
namespace {

constexpr double kUlps = 8.0;

/// A different number in each lane.
Lanes numbers(double low, double high, Rng& rng) {
  Lanes x(0.0);
  for (int l = 0; l < kWidth<Lanes>; ++l) set_lane(x, l, rng.uniform(low, high));
  return x;
}

void expect_close(double value, double expected) {
  EXPECT_NEAR(value, expected, kUlps * 1.2e-16 * std::max(std::abs(expected), 1e-300));
}

TEST(Elementary, LanesAgreeWithDouble) {
  Rng rng(1);
  for (int trial = 0; trial < 200; ++trial) {
    const Lanes x = numbers(-90.0, 3.0, rng), positive = numbers(1e-9, 8.0, rng);
    Lanes exponential = x;
    exponentials(&exponential, 1);
    const Turn<Lanes> turn = turn_of(x);
    for (int l = 0; l < kWidth<Lanes>; ++l) {
      expect_close(lane(exponential, l), std::exp(lane(x, l)));
      EXPECT_NEAR(lane(turn.c, l), std::cos(lane(x, l)), 1e-15);
      EXPECT_NEAR(lane(turn.s, l), std::sin(lane(x, l)), 1e-15);
      expect_close(lane(hyperbolic_tangent(positive), l), std::tanh(lane(positive, l)));
      EXPECT_NEAR(lane(logarithm(positive), l), std::log(lane(positive, l)), 1e-14);
    }
  }
}

TEST(Elementary, ALanesBitsDoNotDependOnTheOthers) {
  Rng rng(2);
  for (int trial = 0; trial < 200; ++trial) {
    const Lanes x = numbers(-90.0, 3.0, rng);
    Lanes all[kMaxExponentials];
    for (Lanes& one : all) one = x;
    set_lane(all[0], 0, NAN);
    exponentials(all, 1 + trial % kMaxExponentials);
    for (int l = 1; l < kWidth<Lanes>; ++l) {
      const Lanes same(lane(x, l)), positive(std::abs(lane(x, l)));
      Lanes alone = same;
      exponentials(&alone, 1);
      for (int m = 0; m < kWidth<Lanes>; ++m) EXPECT_EQ(lane(alone, m), lane(all[0], l));
      EXPECT_EQ(lane(turn_of(same).s, 0), lane(turn_of(x).s, l));
      EXPECT_EQ(lane(turn_of(same).c, 0), lane(turn_of(x).c, l));
      EXPECT_EQ(lane(hyperbolic_tangent(same), 0), lane(hyperbolic_tangent(x), l));
      EXPECT_EQ(lane(logarithm(positive), 0), lane(logarithm(magnitude(x)), l));
    }
  }
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

#include "core/world/pose.hpp"

#include <gtest/gtest.h>

#include <complex>
#include <limits>
#include <numbers>

#include "core/math/rng.hpp"

namespace rtg {
namespace {

TEST(Pose, MovesPointsAsAComplexNumberDoes) {
  Rng rng(1);
  for (int trial = 0; trial < 50; ++trial) {
    const Pose p{rng.uniform(-9, 9), rng.uniform(-9, 9), rng.uniform(-50, 50)};
    const Vector2d v(rng.uniform(-2, 2), rng.uniform(-2, 2));
    const std::complex<double> z =
        std::polar(1.0, p.theta) * std::complex<double>(v.x(), v.y()) + std::complex(p.x, p.y);
    EXPECT_NEAR(to_world(p, v).x(), z.real(), 1e-14);
    EXPECT_NEAR(to_world(p, v).y(), z.imag(), 1e-14);
    EXPECT_LT((to_local(p, to_world(p, v)) - v).norm(), 1e-13);
  }
}

TEST(Pose, TurnsCounterClockwise) {
  EXPECT_LT((rotate(std::numbers::pi / 2.0, {2.0, 0.0}) - Vector2d(0.0, 2.0)).norm(), 1e-15);
}

TEST(Pose, SinglePrecisionIsTheNearestAndStaysAsItIs) {
  const Pose p{0.1, -1e9 / 3.0, 123.456};
  const Pose single = to_single(p);
  EXPECT_EQ(single, (Pose{0.1F, -1e9F / 3.0F, 123.456F}));
  EXPECT_NE(single, p);
  EXPECT_EQ(to_single(single), single);
  EXPECT_NEAR(single.theta, p.theta, 123.456 * 0x1p-24);  // half a unit in the last place
}

TEST(Pose, OneBadCoordinateMakesAStateNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(is_finite(Poses{{1, 2, 3}, {-1e300, 0, 0}}));
  EXPECT_TRUE(is_finite(Poses{}));
  for (const double bad : {nan, inf, -inf}) {
    EXPECT_FALSE(is_finite(Poses{{0, 0, 0}, {bad, 0, 0}}));
    EXPECT_FALSE(is_finite(Poses{{0, bad, 0}, {0, 0, 0}}));
    EXPECT_FALSE(is_finite(Poses{{0, 0, 0}, {0, 0, bad}}));
  }
}

}  // namespace
}  // namespace rtg

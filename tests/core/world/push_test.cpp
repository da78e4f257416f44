#include "core/world/push.hpp"

#include <gtest/gtest.h>

#include <complex>
#include <numbers>

namespace rtg {
namespace {

TEST(Push, DirectionsAreThePowersOfTheFirst) {
  for (const int headings : {1, 5, 48, 360}) {
    const PushConfig config{headings, {2.0}, 8.0};
    const std::complex<double> first = std::polar(1.0, 2.0 * std::numbers::pi / headings);
    std::complex<double> d = 1.0;
    for (int action = 0; action < headings; ++action, d *= first) {
      EXPECT_NEAR(direction(action, config).x(), d.real(), 1e-13);
      EXPECT_NEAR(direction(action, config).y(), d.imag(), 1e-13);
    }
  }
}

TEST(Push, ActionsCountCounterClockwiseFromX) {
  const PushConfig config;
  EXPECT_LT((direction(0, config) - Vector2d(1, 0)).norm(), 1e-15);
  EXPECT_LT((direction(12, config) - Vector2d(0, 1)).norm(), 1e-15);
  EXPECT_LT((direction(24, config) - Vector2d(-1, 0)).norm(), 1e-15);
  EXPECT_LT((direction(36, config) - Vector2d(0, -1)).norm(), 1e-15);
}

TEST(Push, TargetIsOneStrideAheadWithTheHeadingHeld) {
  const PushConfig config{4, {1.5}, 8.0};
  const Pose target = push_target({0.5, -1.0, 7.0}, stroke_of(1, config), config);
  EXPECT_NEAR(target.x, 0.5, 1e-15);
  EXPECT_NEAR(target.y, 0.5, 1e-15);
  EXPECT_EQ(target.theta, 7.0);
}

// The headings with the first stride, then those with the second.
TEST(Push, EachStrideHasAllHeadings) {
  const PushConfig config{4, {0.5, 1.5}, 8.0};
  EXPECT_EQ(action_count(config), 8);
  EXPECT_EQ(longest_stride(config), 1.5);
  for (int action = 0; action < 8; ++action) {
    EXPECT_EQ(stride_index(action, config), action < 4 ? 0 : 1);
    EXPECT_EQ(direction(action, config), direction(action % 4, config));
    const Pose target = push_target({0, 0, 0.3}, stroke_of(action, config), config);
    EXPECT_NEAR(target.position().norm(), action < 4 ? 0.5 : 1.5, 1e-15);
    EXPECT_EQ(push_target({0, 0, 0.3}, stroke_of(action % 4, with_stride_of(action, config)),
                          with_stride_of(action, config)),
              target);
  }
}

TEST(Push, TargetIsClippedToTheArenaInEachCoordinate) {
  const PushConfig config{8, {2.0}, 3.0};
  const Pose corner =
      push_target({2.5, -2.0, 0.1}, stroke_of(7, config), config);  // to (3.91, -3.41)
  EXPECT_EQ(corner, (Pose{3.0, -3.0, 0.1}));
  const Pose edge = push_target({2.5, 0.0, 0.1}, stroke_of(1, config), config);  // to (3.91, 1.41)
  EXPECT_EQ(edge.x, 3.0);
  EXPECT_NEAR(edge.y, std::numbers::sqrt2, 1e-15);
}

TEST(Push, TheArenaIsASquareWithItsEdge) {
  const PushConfig config{8, {2.0}, 3.0};
  EXPECT_TRUE(in_arena({3.0, -3.0, 9.0}, config));
  EXPECT_FALSE(in_arena({3.0 + 1e-9, 0.0, 0.0}, config));
  EXPECT_FALSE(in_arena({0.0, -3.0 - 1e-9, 0.0}, config));
}

}  // namespace
}  // namespace rtg

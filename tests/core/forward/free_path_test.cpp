#include "core/forward/free_path.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "core/world/separation.hpp"
#include "tests/support/random_push.hpp"

namespace rtg::forward {
namespace {

constexpr double kNear = 0.05;  // [m]

/// A square robot of 1 m and a box of 1 m at `box`.
Scene two_boxes() {
  return {{{"robot", "robot", box(1.0, 1.0), 1.0, 0.5, false},
           {"box", "box", box(1.0, 1.0), 1.0, 0.5, false}}};
}

double free_length(const Pose& box, const Pose& to) {
  return free_path_length(two_boxes(), {{0, 0, 0}, box}, to);
}

TEST(FreePath, EndsWhereABodyIsNear) {
  EXPECT_NEAR(free_length({3, 0, 0}, {4, 0, 0}), 2.0 - kNear, 0.006);
  EXPECT_NEAR(free_length({3, 0.9, 0}, {4, 0, 0}), 2.0 - kNear, 0.006);
  EXPECT_EQ(free_length({1.02, 0, 0}, {2, 0, 0}), 0.0);
}

// Corner beside corner, so that the circles around the bodies do not touch.
TEST(FreePath, EndsWhereTheCornersOfTwoBodiesAreNear) {
  const Scene scene = two_boxes();
  const double corner = std::numbers::pi / 4.0, beside = std::numbers::sqrt2 + 0.03;
  const Poses poses{{0, 0, corner}, {3, beside, corner}};
  EXPECT_LT(free_path_length(scene, poses, {4, 0, corner}), 3.0);
}

TEST(FreePath, IsTheWholePathPastBodiesBesideAndBehind) {
  EXPECT_EQ(free_length({3, 1.2, 0}, {4, 0, 0}), 4.0);
  EXPECT_EQ(free_length({-1.2, 0, 0}, {4, 0, 0}), 4.0);
  EXPECT_EQ(free_length({9, 0, 0}, {4, 0, 0}), 4.0);
  EXPECT_EQ(free_length({3, 0, 0}, {0, 0, 0}), 0.0);  // no path at all
}

// Against steps of 1 mm.
TEST(FreePath, NoBodyIsNearBeforeItsEnd) {
  const PushConfig push;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const testing::RandomPush drawn = testing::random_push(seed, push);
    const Pose to = push_target(drawn.start[0], stroke_of(drawn.action, push), push);
    const double clear = free_path_length(drawn.scene, drawn.start, to);
    const double length = (to.position() - drawn.start[0].position()).norm();
    double least = INFINITY, at_end = INFINITY;
    for (double travelled = 0.0; travelled < clear; travelled += 1e-3) {
      Poses poses = drawn.start;
      poses[0].x += travelled / length * (to.x - poses[0].x);
      poses[0].y += travelled / length * (to.y - drawn.start[0].y);
      at_end = INFINITY;
      for (std::size_t j = 1; j < poses.size(); ++j)
        at_end = std::min(at_end, separation(drawn.scene.bodies[0].shape, poses[0],
                                             drawn.scene.bodies[j].shape, poses[j]));
      least = std::min(least, at_end);
    }
    EXPECT_GE(least, kNear - 1e-9) << seed;
    if (clear > 0.0 && clear < length) {
      EXPECT_LT(at_end, kNear + 0.01) << seed;
    }
  }
}

}  // namespace
}  // namespace rtg::forward

#include "core/world/selection.hpp"

#include <gtest/gtest.h>

namespace rtg {
namespace {

/// Robot, wall, box, wall, box.
Scene mixed_scene() {
  Scene scene;
  for (const bool fixed : {false, true, false, true, false})
    scene.bodies.push_back(
        {"body" + std::to_string(scene.size()), "", box(1.0, 1.0), 1.0, 0.5, fixed});
  return scene;
}

Poses numbered_poses() {
  Poses poses;
  for (int k = 0; k < 5; ++k) poses.push_back({1.0 * k, 10.0 * k, 0.1 * k});
  return poses;
}

TEST(Selection, TakesBodiesAndPosesInTheOrderAskedFor) {
  const Scene scene = mixed_scene();
  const Selection s = select(scene, numbered_poses(), {4, 0, 3});
  EXPECT_EQ(s.poses, (Poses{{4.0, 40.0, 0.4}, {0.0, 0.0, 0.0}, {3.0, 30.0, 0.1 * 3}}));
  ASSERT_EQ(s.scene.size(), 3U);
  EXPECT_EQ(s.scene.bodies[0], scene.bodies[4]);
  EXPECT_EQ(s.scene.bodies[1], scene.bodies[0]);
  EXPECT_EQ(s.scene.bodies[2], scene.bodies[3]);
}

TEST(Selection, MovableBodiesComeFirstAndKeepTheirOrder) {
  EXPECT_EQ(movable_first(mixed_scene()), (std::vector<int>{0, 2, 4, 1, 3}));
  EXPECT_EQ(movable_first({}), std::vector<int>{});
}

TEST(Selection, MergedReplacesThePosesOfThePartAlone) {
  const Poses part{{-4.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}};
  Poses expected = numbered_poses();
  expected[4] = part[0];
  expected[1] = part[1];
  EXPECT_EQ(merged(numbered_poses(), part, {4, 1}), expected);
}

TEST(Selection, MergedUndoesSelect) {
  const std::vector<int> order = movable_first(mixed_scene());
  const Selection s = select(mixed_scene(), numbered_poses(), order);
  EXPECT_EQ(merged(Poses(5), s.poses, order), numbered_poses());
}

}  // namespace
}  // namespace rtg

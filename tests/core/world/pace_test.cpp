#include "core/world/pace.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace rtg {
namespace {

TEST(Paces, AreThoseAtWhichTheRobotsForceIsEnough) {
  Scene scene{{{"robot", "robot", box(1, 1)},
               {"light", "box", box(1, 1)},
               {"heavy", "box", box(1, 2), 8.0},
               {"wall", "wall", box(1, 2), 8.0, 0.5, true}}};
  PhysicsConfig physics;
  physics.force_factor = 5.0;
  const std::vector<double> found = paces(scene, physics);
  EXPECT_EQ(found, (std::vector{1.0, 1.0, 0.99 * 5.0 / 17.0, 1.0}));
  scene.joints.push_back({1, 2, {0.5, 0.0}, {-0.5, 0.0}});
  EXPECT_EQ(paces(scene, physics), std::vector(4, 1.0)) << "with joints";
}

}  // namespace
}  // namespace rtg

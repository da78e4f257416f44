#include "core/reverse/problem/reverse_model.hpp"

#include <gtest/gtest.h>

#include "tests/support/gathering.hpp"

namespace rtg::reverse {
namespace {

TEST(ReverseModel, RobotDensityIsAFactor) {
  Scene scene = testing::gathering().scene;
  scene.bodies[0].density = 2.0;
  ReverseConfig config;
  config.robot_density = 3.0;
  const ReverseModel model = reverse_model(scene, {}, config);
  EXPECT_EQ(model.scene.bodies[0].density, 6.0);
  for (std::size_t k = 1; k < scene.size(); ++k) EXPECT_EQ(model.scene.bodies[k], scene.bodies[k]);
}

}  // namespace
}  // namespace rtg::reverse

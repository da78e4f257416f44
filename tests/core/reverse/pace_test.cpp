#include "core/reverse/pace.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/touching_scene.hpp"

namespace rtg::reverse {
namespace {

/// The touching scene with a second box of which the robot has too little force.
struct HeavyScene : testing::TouchingScene {
  HeavyScene() {
    scene.bodies[2].density = 8.0;
    update();
  }
};

TEST(Pace, TheRobotsForceIsEnoughForTheHeaviestBody) {
  const HeavyScene heavy;
  const ReverseConfig config;
  const double robot = mass_of(heavy.scene.bodies[0]).mass,
               box = mass_of(heavy.scene.bodies[2]).mass;
  const double pace = least_pace(heavy.problem(config), heavy.scene);
  EXPECT_NEAR(pace * (robot + box), 0.99 * heavy.physics.force_factor * robot, 1e-9);
  const testing::TouchingScene light;
  EXPECT_EQ(least_pace(light.problem(config), light.scene), 1.0);
}

TEST(Pace, BodiesWithJointsAndRobotsWithoutAPathHaveThatOfTheAction) {
  HeavyScene heavy;
  ReverseConfig config;
  config.path_weight = 0.0;
  EXPECT_EQ(least_pace(heavy.problem(config), heavy.scene), 1.0);
  config = {};
  heavy.scene.joints.push_back({1, 2, {1.0, 0.0}, {-1.0, 0.0}});
  heavy.update();
  EXPECT_EQ(least_pace(heavy.problem(config), heavy.scene), 1.0);
}

/// The pace of a push to the right with these shares of the largest force, found at `pace`.
double sustained(double pace, const std::vector<double>& shares) {
  const testing::TouchingScene scene;
  const ReverseConfig config;
  ReverseProblem problem = scene.problem(config);
  problem.pace = pace;
  Iterate x = static_iterate(problem);
  for (std::size_t k = 0; k < shares.size(); ++k) x.controls[k + 1][0] = std::atanh(shares[k]);
  return sustained_pace(problem, x);
}

// With pace 0.6, the share 0.8 allows 0.75, and 0.3 twice the speed of the action.
TEST(Pace, TheRobotLagsWhereItsForceIsNotEnoughAndCatchesUpWhereItIs) {
  EXPECT_NEAR(sustained(0.6, std::vector<double>(10, 0.8)), 0.75, 1e-9);
  std::vector<double> shares(10, 0.3);
  EXPECT_EQ(sustained(0.6, shares), 1.0);
  shares[8] = shares[9] = 0.8;
  EXPECT_NEAR(sustained(0.6, shares), 0.95, 1e-9) << "lags at the end by twice a quarter";
  std::swap(shares[8], shares[0]);
  EXPECT_NEAR(sustained(0.6, shares), 0.975, 1e-9) << "and by one, having made up for the other";
  EXPECT_EQ(sustained(0.6, std::vector<double>(10, 0.0)), 1.0);
}

}  // namespace
}  // namespace rtg::reverse

#include "core/reverse/problem/warm_start.hpp"

#include <gtest/gtest.h>

#include "tests/support/touching_scene.hpp"

namespace rtg::reverse {
namespace {

using testing::TouchingScene;

// The servo's lead makes up for its lag in free motion.
TEST(WarmStart, AFreeRobotKeepsToItsPath) {
  const TouchingScene scene;
  const ReverseConfig config;
  ReverseProblem problem = scene.problem(config);
  problem.end = energy::stacked({{0, 0, 0.3}, {20, 0, 0}, {0, 20, 0}});
  const auto x = warm_start(problem);
  ASSERT_TRUE(x);
  for (int k = 0; k <= problem.sub_steps; ++k) {
    const Vector3d path(-0.2 * (problem.sub_steps - k), 0.0, 0.3);
    EXPECT_LT((x->p[static_cast<std::size_t>(k)].head<3>() - path).norm(), 1e-6);
  }
}

TEST(WarmStart, IsFeasibleAndEndsNearTheEnd) {
  const TouchingScene scene;
  const ReverseConfig config;
  const ReverseProblem problem = scene.problem(config);
  const auto x = warm_start(problem);
  ASSERT_TRUE(x);
  EXPECT_LT(violation(problem, *x).max(), 1e-6);
  EXPECT_LT(terminal_miss(problem, *x), 0.1);
}

// A gap of 0.0087 carries the box's drag at push speed: before the last sub-step it was a stride of
// a sub-step, 0.2, further back.
TEST(WarmStart, DragsATouchedBodyAgainstThePush) {
  const TouchingScene scene;
  const ReverseConfig config;
  ReverseProblem problem = scene.problem(config);
  problem.end = energy::stacked({{0, 0, 0}, {1.4 + 0.0087, 0, 0}, {20, 0, 0}});
  const auto x = warm_start(problem);
  ASSERT_TRUE(x);
  const VectorXd moved = x->p[0] - problem.end;
  EXPECT_NEAR(moved[0], -2.0, 0.01);
  EXPECT_LT(moved[3], -0.19);
  EXPECT_NEAR(moved[4], 0.0, 1e-6);
  EXPECT_LT(terminal_miss(problem, *x), 0.01);
}

// The second box lies half in the robot's way back, half a metre behind it.
TEST(WarmStart, ABodyInTheWayBackIsPushedOutOfIt) {
  const TouchingScene scene;
  const ReverseConfig config;
  ReverseProblem problem = scene.problem(config);
  problem.end = energy::stacked({{0, 0, 0}, {20, 0, 0}, {-2.0, 0.9, 0}});
  const auto x = warm_start(problem);
  ASSERT_TRUE(x);
  EXPECT_NEAR(x->p[0][0], -2.0, 0.02);
  EXPECT_GT(x->p[0][7], 1.2);  // the robot's half height and its own
  EXPECT_LT(violation(problem, *x).max(), 1e-6);
}

// The bar that the robot has pushed reaches beyond the robot's side, where a wall touches its back.
TEST(WarmStart, TheRobotGoesBackAloneWhereTheBodyCannot) {
  TouchingScene scene;
  scene.scene.bodies[1].shape = box(1.2, 6.0);
  scene.scene.bodies[2].fixed = true;
  scene.update();
  scene.poses = {{0, 0, 0}, {1.4087, 0, 0}, {1.4087 - 1.2087, 2.0, 0}};
  const ReverseConfig config;
  const auto x = warm_start(scene.problem(config));
  ASSERT_TRUE(x);
  EXPECT_NEAR(x->p[0][0], -2.0, 0.01);
  EXPECT_NEAR(x->p[0][3], 1.4087, 0.01);
}

// The box rests half a sub-step's stride, 0.1, beyond the gap at which the robot pushes it: as far
// as objects coast at k_D = 2. Mirrored from a whole stride beyond, it would miss its place by
// 0.05.
TEST(WarmStart, MirroringBeginsAsFarBeyondTheRobotsPathAsObjectsCoast) {
  testing::CoastingScene scene;
  scene.physics.damping = 2.0;
  scene.update();
  const ReverseConfig config;
  ReverseProblem problem = scene.problem(config);
  problem.end = energy::stacked({{0, 0, 0}, {1.4 + 0.0087 + 0.1, 0, 0}, {20, 0, 0}});
  const auto x = warm_start(problem);
  ASSERT_TRUE(x);
  EXPECT_LT(x->p[0][3] - problem.end[3], -0.5);
  EXPECT_LT(terminal_miss(problem, *x), 0.01);
}

TEST(WarmStart, SimulatesThePushFromAnyStart) {
  const TouchingScene scene;
  const ReverseConfig config;
  const ReverseProblem problem = scene.problem(config);
  ProblemLanes<double> lanes(problem);
  lanes.load(0, problem);
  Trajectory<double> x(lanes.energy, problem.sub_steps);
  Iterate start = *warm_start(problem);
  start.p[0][4] += 0.3;  // moves the first box aside
  x.load(0, problem, start);
  ASSERT_TRUE(WarmStart<double>(lanes).simulate(true, x));
  const Iterate simulated = x.unload(0, problem);
  EXPECT_EQ(simulated.p[0], start.p[0]);
  EXPECT_LT(violation(problem, simulated).max(), 1e-6);
  EXPECT_NEAR(simulated.p.back()[0], problem.end[0], 0.05);  // the robot has gone its way
  for (const VectorXd& y : simulated.multipliers) EXPECT_EQ(y.norm(), 0.0);
}

TEST(WarmStart, LeavesUntouchedBodiesAlone) {
  const TouchingScene scene;
  const ReverseConfig config;
  ReverseProblem problem = scene.problem(config);
  problem.end[4] += 20.0;
  problem.end[7] -= 20.0;
  const auto x = warm_start(problem);
  ASSERT_TRUE(x);
  for (const VectorXd& p : x->p) EXPECT_EQ(p.tail(6), problem.end.tail(6));
  EXPECT_LT(terminal_miss(problem, *x), 1e-6);
}

TEST(WarmStart, OfAnOverlappingEndThereIsNone) {
  const TouchingScene scene;
  const ReverseConfig config;
  ReverseProblem problem = scene.problem(config);
  problem.end = energy::stacked({{0, 0, 0}, {1, 0, 0}, {5, 0, 0}});
  EXPECT_FALSE(warm_start(problem));
}

}  // namespace
}  // namespace rtg::reverse

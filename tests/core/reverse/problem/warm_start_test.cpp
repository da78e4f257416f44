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

// The gap is wider than one across which the robot drags the box by 0.02.
TEST(WarmStart, WithFullContactDragsABodyOverTheWholeWayInSpiteOfSlack) {
  const TouchingScene scene;
  const ReverseConfig config;
  ReverseProblem problem = scene.problem(config);
  problem.end = energy::stacked({{0, 0, 0}, {1.4 + 0.0287, 0, 0}, {20, 0, 0}});
  const auto full = warm_start(problem), next = warm_start(problem, false);
  ASSERT_TRUE(full && next);
  const auto dragged = [&](const Iterate& x) { return x.p[0][3] - problem.end[3]; };
  EXPECT_NEAR(dragged(*full), -2.0, 0.05);
  EXPECT_GT(dragged(*next), -1.0);
  EXPECT_LT(terminal_miss(problem, *full), 0.03);
}

// No push moves it by two thirds of what one more would.
TEST(WarmStart, WithFullContactLeavesABodyAloneThatTheRobotHardlyReached) {
  const TouchingScene scene;
  const ReverseConfig config;
  ReverseProblem problem = scene.problem(config);
  problem.end = energy::stacked({{0, 0, 0}, {1.4 + 0.145, 0, 0}, {20, 0, 0}});
  const auto x = warm_start(problem);
  ASSERT_TRUE(x);
  EXPECT_GT(x->p[0][3] - problem.end[3], -0.1);
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

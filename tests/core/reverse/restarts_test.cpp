#include "core/reverse/restarts.hpp"

#include <gtest/gtest.h>

#include "core/reverse/rollout.hpp"
#include "tests/support/touching_scene.hpp"

namespace rtg {
namespace {

using testing::TouchingScene;

TEST(Restarts, SolvesTheTouchingScene) {
  const TouchingScene scene;
  const ReverseConfig config;
  const ReverseProblem problem = scene.problem(config);
  const SqpResult result = solve_with_restarts(problem);
  ASSERT_EQ(result.status, SolveStatus::kConverged);
  EXPECT_LT(violation(problem, result.x).max(), config.feasibility_tol);
  EXPECT_LT(terminal_miss(problem, result.x), config.terminal_tolerance);
  EXPECT_EQ(result.infeasibility, violation(problem, result.x).max());
  EXPECT_LE(result.iterations, config.max_iterations);
}

// The warm start alone ends elsewhere.
TEST(Restarts, WhereTheFinalStateIsFixedTheSolutionEndsInIt) {
  const TouchingScene scene;
  ReverseConfig config;
  ReverseProblem problem = scene.problem(config);
  problem.end = stacked({{0, 0, 0}, {1.41, 0.2, 0.05}, {20, 0, 0}});
  config.terminal_weight = 0.0;
  ASSERT_GT(terminal_miss(problem, *warm_start(problem)), 1e-4);
  const SqpResult result = solve_with_restarts(problem);
  ASSERT_EQ(result.status, SolveStatus::kConverged);
  EXPECT_EQ(result.x.p.back(), problem.end);
  EXPECT_LT(violation(problem, result.x).max(), config.feasibility_tol);
}

TEST(Restarts, AnOverlappingEndIsInfeasible) {
  const TouchingScene scene;
  const ReverseConfig config;
  ReverseProblem problem = scene.problem(config);
  problem.end = stacked({{0, 0, 0}, {1, 0, 0}, {5, 0, 0}});
  const SqpResult result = solve_with_restarts(problem);
  EXPECT_EQ(result.status, SolveStatus::kInfeasible);
  EXPECT_EQ(result.iterations, 0);
  EXPECT_EQ(result.x.p[0], problem.end);
}

TEST(Restarts, AttemptsShareTheIterationLimit) {
  const TouchingScene scene;
  ReverseConfig config;
  config.max_iterations = 3;
  const SqpResult result = solve_with_restarts(scene.problem(config));
  EXPECT_EQ(result.status, SolveStatus::kIterationLimit);
  EXPECT_EQ(result.iterations, 3);
}

}  // namespace
}  // namespace rtg

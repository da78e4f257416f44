#include "core/reverse/restarts.hpp"

#include <gtest/gtest.h>

#include "core/reverse/candidate.hpp"
#include "core/reverse/filter_sqp.hpp"
#include "core/reverse/rollout.hpp"
#include "tests/support/gathering.hpp"
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

/// Lines 586, 620, 647, 654 and 990 of tests/bench/corpus/problems.txt, on which the first attempt
/// gets stuck; on another processor, rounding may save one or the other.
const std::vector<ReverseJob> kStuck{{{{-3.28443503, 0.49693498, 0.00739911618},
                                       {-2.04783583, 1.50942683, -1.7403661},
                                       {2.71855044, 2.15805197, 0.280171692},
                                       {2.34716129, -2.13839197, 1.74777508}},
                                      41},
                                     {{{2.42285872, 2.21452594, -0.00326369028},
                                       {-1.43198597, 0.348498374, -1.59337211},
                                       {2.75083327, 0.804926038, -0.19779171},
                                       {2.34919047, -2.14103651, 1.74777508}},
                                      46},
                                     {{{-3.28443503, 0.49693498, 0.00739911618},
                                       {-2.04783583, 1.50942683, -1.7403661},
                                       {2.71855044, 2.15805197, 0.280171692},
                                       {2.34716129, -2.13839197, 1.74777508}},
                                      3},
                                     {{{-3.54076695, 1.23159719, 0.00474895304},
                                       {-2.0660708, 1.19043505, -1.16818511},
                                       {2.71855044, 2.15805197, 0.280171692},
                                       {2.34716129, -2.13839197, 1.74777508}},
                                      42},
                                     {{{-1.6214416, 1.16182077, 0},
                                       {-0.538810432, 0.313336402, 1.0854857},
                                       {0.613581002, 1.21110106, -0.741354764},
                                       {0.642027736, -0.548788011, -3.09701324}},
                                      33}};

TEST(Restarts, GetOutWhereTheFirstAttemptIsStuckWithinTheSharedLimit) {
  const Task task = testing::gathering();
  const PhysicsConfig physics;
  int stuck = 0, freed = 0;
  for (const ReverseJob& job : kStuck) {
    ReverseConfig config;
    const Candidate candidate(task.scene, physics, task.push, config, job);
    const ReverseProblem& problem = candidate.problem();
    const SqpResult first = filter_sqp(problem, *warm_start(problem), 200, config.proximal_start);
    if (first.status == SolveStatus::kConverged) continue;
    ++stuck;
    const SqpResult whole = solve_with_restarts(problem);
    freed += whole.status == SolveStatus::kConverged && whole.iterations > first.iterations;
    config.max_iterations = first.iterations + 1;
    const SqpResult cut = solve_with_restarts(problem);
    EXPECT_EQ(cut.status, SolveStatus::kIterationLimit);
    EXPECT_EQ(cut.iterations, first.iterations + 1);
  }
  EXPECT_GE(stuck, 2);
  EXPECT_GE(freed, stuck - 1);
}

}  // namespace
}  // namespace rtg

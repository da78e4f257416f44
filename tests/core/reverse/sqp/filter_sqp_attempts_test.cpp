// What attempts and shaking add to the solver's core.

#include <gtest/gtest.h>

#include "core/reverse/candidate.hpp"
#include "tests/support/one_candidate.hpp"
#include "tests/support/touching_scene.hpp"

namespace rtg {
namespace {

/// Lines 614, 621, 681, 713 and 746 of tests/bench/corpus/problems.txt.
const std::vector<ReverseJob> kLetGo{{{{-3.54076695, 1.23159719, 0.00474895304},
                                       {-2.0660708, 1.19043505, -1.16818511},
                                       {2.71855044, 2.15805197, 0.280171692},
                                       {2.34716129, -2.13839197, 1.74777508}},
                                      45},
                                     {{{-3.28443503, 0.49693498, 0.00739911618},
                                       {-2.04783583, 1.50942683, -1.7403661},
                                       {2.71855044, 2.15805197, 0.280171692},
                                       {2.34716129, -2.13839197, 1.74777508}},
                                      10},
                                     {{{2.24163604, 2.63560176, 0.00346551347},
                                       {-1.43198597, 0.348498374, -1.59337211},
                                       {3.18465018, 1.58098543, -0.43862167},
                                       {2.34716129, -2.13839197, 1.74777508}},
                                      33},
                                     {{{-3.45753098, 1.48847556, 0.00573315518},
                                       {-1.90782154, 1.58555341, -1.9769659},
                                       {2.71855044, 2.15805197, 0.280171692},
                                       {2.34716129, -2.13839197, 1.74777508}},
                                      7},
                                     {{{2.29444551, -2.28759646, 0},
                                       {-1.4289068, 0.349773824, -1.59337211},
                                       {1.40985918, 0.168148413, -0.288589776},
                                       {1.27493978, -1.14126623, 1.28220654}},
                                      26}};

SqpResult solve(const ReverseJob& job, const ReverseConfig& config, double* objective = nullptr) {
  const Task task = testing::gathering();
  const PhysicsConfig physics;
  const Candidate candidate(task.scene, physics, task.push, config, job);
  SqpResult result = testing::solved(candidate.problem());
  if (objective != nullptr) *objective = rtg::objective(candidate.problem(), result.x);
  return result;
}

// Without it the object slips away from the robot after the last sub-steps; rounding may make it
// slip, or be found, on another processor.
TEST(FilterSqpShaking, FindsThatAnObjectCanBeDraggedAlong) {
  int found = 0;
  for (const ReverseJob& job : kLetGo) {
    ReverseConfig config;
    double shaken = 0.0, still = 0.0;
    EXPECT_EQ(solve(job, config, &shaken).status, SolveStatus::kConverged);
    config.shakes = 0;
    EXPECT_EQ(solve(job, config, &still).status, SolveStatus::kConverged);
    EXPECT_LT(shaken, still + 1e-3);
    found += shaken < still - 0.5;
  }
  EXPECT_GE(found, 3);
}

// A direction in which the solver is soon near the solution, as shaking wants.
TEST(FilterSqpShaking, IsNotTriedWhereTheFinalStateIsFixed) {
  const testing::TouchingScene scene;
  ReverseConfig config;
  config.terminal_weight = 0.0;
  ReverseProblem problem = scene.problem(config);
  problem.direction = direction(12, scene.task.push);
  const SqpResult shaken = testing::solved(problem);
  config.shakes = 0;
  const SqpResult still = testing::solved(problem);
  ASSERT_LT(still.iterations, 12);
  EXPECT_EQ(shaken.iterations, still.iterations);
  EXPECT_EQ(shaken.x.p[0], still.x.p[0]);
}

// No solution ends nearer to the final state than the force on the touched object compresses the
// spring there.
TEST(FilterSqpAttempts, OfSolutionsThatMissTheFinalStateTheFirstIsKept) {
  const ReverseJob& job = kLetGo[3];
  ReverseConfig config;
  const SqpResult hit = solve(job, config);
  ASSERT_EQ(hit.status, SolveStatus::kConverged);
  EXPECT_EQ(hit.attempts, 1);
  config.terminal_tolerance = 1e-4;
  const SqpResult missed = solve(job, config);
  EXPECT_EQ(missed.status, SolveStatus::kInfeasible);
  EXPECT_EQ(missed.attempts, 2);
  EXPECT_GT(missed.iterations, hit.iterations);
  EXPECT_EQ(missed.x.p[0], hit.x.p[0]);
  EXPECT_EQ(missed.stationarity, hit.stationarity);
  ReverseConfig second;  // as the second attempt: not shaken, with a larger first δ
  second.shakes = 0;
  second.proximal_start = 4.0;
  EXPECT_EQ(missed.iterations, hit.iterations + solve(job, second).iterations);
  config.max_iterations = hit.iterations + 1;  // ends the second attempt
  const SqpResult cut = solve(job, config);
  EXPECT_EQ(cut.status, SolveStatus::kInfeasible);
  EXPECT_EQ(cut.iterations, config.max_iterations);
  EXPECT_EQ(cut.x.p[0], hit.x.p[0]);
}

}  // namespace
}  // namespace rtg

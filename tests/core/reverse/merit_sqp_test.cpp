#include "core/reverse/merit_sqp.hpp"

#include <gtest/gtest.h>

#include "tests/support/free_push.hpp"
#include "tests/support/touching_scene.hpp"

namespace rtg {
namespace {

using testing::TouchingScene;

/// The touching scene with the paper's barrier, solved the paper's way.
struct PaperScene : TouchingScene {
  ReverseConfig config = reverse_preset(ReversePreset::kPaper);

  PaperScene() {
    physics.plain_barrier = true;
    energy = StepEnergy(scene, physics, task.push);
  }
  ReverseProblem problem() const { return TouchingScene::problem(config); }
};

/// The robot alone, pushed along (0.6, 0.8): nothing to touch, at any distance.
struct FreeRobot : PaperScene {
  FreeRobot() {
    scene.bodies.resize(1);
    energy = StepEnergy(scene, physics, task.push);
    config = testing::free_push_config(config);
  }
  ReverseProblem problem() const { return {energy, config, stacked({{1, 2, 0.3}}), {0.6, 0.8}, 10}; }
};

TEST(MeritSqp, ReverseOfAFreePushIsTheClosedForm) {
  FreeRobot free;
  free.config.stationarity_tol = 1e-6;  // over a curvature of 0.01
  const ReverseProblem problem = free.problem();
  const SqpResult result = merit_sqp(problem, static_iterate(problem));
  ASSERT_EQ(result.status, SolveStatus::kConverged);
  testing::expect_closed_form(problem, result.x, 1e-4);
}

TEST(MeritSqp, TheLastIterateThatTheLimitAllowsMayBeTheSolution) {
  FreeRobot free;
  const ReverseProblem problem = free.problem();
  const SqpResult unlimited = merit_sqp(problem, static_iterate(problem));
  ASSERT_EQ(unlimited.status, SolveStatus::kConverged);
  free.config.max_iterations = unlimited.iterations;
  const SqpResult just = merit_sqp(problem, static_iterate(problem));
  EXPECT_EQ(just.status, SolveStatus::kConverged);
  EXPECT_EQ(just.iterations, unlimited.iterations);
  --free.config.max_iterations;
  const SqpResult short_of_it = merit_sqp(problem, static_iterate(problem));
  EXPECT_EQ(short_of_it.status, SolveStatus::kIterationLimit);
  EXPECT_EQ(short_of_it.iterations, unlimited.iterations - 1);
}

TEST(MeritSqp, IterationsKeepTheObjectiveFallingOrTheConstraintsHolding) {
  PaperScene scene;
  scene.config.max_iterations = 15;
  const ReverseProblem problem = scene.problem();
  const Iterate start = static_iterate(problem);
  const SqpResult result = merit_sqp(problem, start);
  EXPECT_EQ(result.iterations, 15);
  EXPECT_EQ(result.status, SolveStatus::kIterationLimit);
  const double before = violation(problem, start).l1(), after = violation(problem, result.x).l1();
  EXPECT_TRUE(after < before || objective(problem, result.x) < objective(problem, start));
  EXPECT_EQ(result.x.p.back(), problem.end);
  for (std::size_t k = 0; k < result.x.p.size(); ++k)
    EXPECT_EQ(result.x.forces[k], scene.energy.forces(result.x.p[k]));
}

TEST(MeritSqp, EveryKktMethodTakesTheSameSteps) {
  PaperScene scene;
  scene.config.max_iterations = 5;
  const ReverseProblem problem = scene.problem();
  const SqpResult first = merit_sqp(problem, static_iterate(problem));
  ASSERT_EQ(first.status, SolveStatus::kIterationLimit);
  for (const KktMethod method : {KktMethod::kCyclicReduction, KktMethod::kSuiteSparse}) {
    scene.config.kkt = method;
    const SqpResult other = merit_sqp(problem, static_iterate(problem));
    for (std::size_t k = 0; k < first.x.p.size(); ++k)
      EXPECT_LT((other.x.p[k] - first.x.p[k]).norm(), 1e-5) << k;
  }
}

TEST(MeritSqp, ReportsWhatIsNotFinite) {
  const PaperScene scene;
  const ReverseProblem problem = scene.problem();
  Iterate start = static_iterate(problem);
  start.controls[3][1] = NAN;
  EXPECT_EQ(merit_sqp(problem, start).status, SolveStatus::kNonFinite);
}

TEST(MeritSqp, ReportsAStartFromWhichNoStepIsLegal) {
  const PaperScene scene;
  ReverseProblem problem = scene.problem();
  problem.end = stacked({{0, 0, 0}, {40, 0, 0}, {40.9, 0.2, 0}});
  EXPECT_EQ(merit_sqp(problem, static_iterate(problem)).status, SolveStatus::kLineSearchFailed);
}

TEST(MeritSqp, ReportsSingularSystems) {
  PaperScene scene;
  scene.scene.bodies[2].density = 1e25;
  scene.energy = StepEnergy(scene.scene, scene.physics, scene.task.push);
  const ReverseProblem problem = scene.problem();
  EXPECT_EQ(merit_sqp(problem, static_iterate(problem)).status, SolveStatus::kSingular);
}

}  // namespace
}  // namespace rtg

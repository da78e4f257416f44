#include "core/reverse/sqp/merit_sqp.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/forward/box2d_simulator.hpp"
#include "core/reverse/problem/reverse_model.hpp"
#include "core/reverse/sqp/l1_merit.hpp"
#include "tests/support/free_push.hpp"
#include "tests/support/linearisation.hpp"
#include "tests/support/touching_scene.hpp"

namespace rtg::reverse {
namespace {

using testing::TouchingScene;

/// The touching scene, solved the paper's way.
struct PaperScene : TouchingScene {
  ReverseConfig config;
  Vector2d push = Vector2d::UnitX();

  explicit PaperScene(const ReverseConfig& given = reverse_preset(ReversePreset::kPaper))
      : config(given) {
    model(scene);
  }

  /// Takes the paper's model of `bodies`.
  void model(const Scene& bodies) {
    const ReverseModel paper = reverse_model(bodies, PhysicsConfig(), config);
    scene = paper.scene;
    physics = paper.physics;
    update();
  }
  ReverseProblem problem() const {
    ReverseProblem out = TouchingScene::problem(config);
    out.direction = push;
    return out;
  }
};

/// The robot alone: nothing to touch, at any distance.
struct FreeRobot : PaperScene {
  explicit FreeRobot(const ReverseConfig& given = reverse_preset(ReversePreset::kPaper))
      : PaperScene(given) {
    scene.bodies.resize(1);
    update();
    poses = {{1, 2, 0.3}};
    push = {0.6, 0.8};
  }
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

/// The iterates of a run, the start first: a run with a smaller limit is the beginning of it.
std::vector<Iterate> iterates(PaperScene& scene, int count) {
  const ReverseProblem problem = scene.problem();
  std::vector<Iterate> out;
  for (int k = 0; k <= count; ++k) {
    scene.config.max_iterations = k;
    const SqpResult result = merit_sqp(problem, static_iterate(problem));
    EXPECT_EQ(result.status, SolveStatus::kIterationLimit);
    EXPECT_EQ(result.iterations, k);
    out.push_back(result.x);
  }
  return out;
}

/// Largest multiplier that the Newton step at `x` leads to.
double next_multiplier(const ReverseProblem& problem, const Iterate& x) {
  const testing::Linearisation lin(problem, x, {false, 1e-6, true});
  const auto kkt = make_kkt_solver(KktMethod::kUmfpack);
  EXPECT_TRUE(kkt->factorize(lin.matrix()));
  const testing::Direction d = lin.direction(kkt->solve(lin.right_hand_side()), true);
  double top = 0.0;
  for (std::size_t k = 1; k < x.multipliers.size(); ++k)
    top = std::max(top, (x.multipliers[k] + d.multipliers[k]).lpNorm<Eigen::Infinity>());
  return top;
}

// The safeguard's ε_c is 1.
void expect_descent(PaperScene scene, int count) {
  const ReverseProblem problem = scene.problem();
  const std::vector<Iterate> x = iterates(scene, count);
  Merit merit;
  for (std::size_t k = 0; k + 1 < x.size(); ++k) {
    merit.raise_weight_above(next_multiplier(problem, x[k]));
    const double before = violation(problem, x[k]).l1(), after = violation(problem, x[k + 1]).l1();
    EXPECT_LT(merit.value(objective(problem, x[k + 1]), after),
              merit.value(objective(problem, x[k]), before))
        << k;
    EXPECT_LE(after, std::max(1.0, before)) << k;
  }
}

/// A small ε, as printed, and a weak barrier, for which the line search has most to do.
ReverseConfig small_weights() {
  ReverseConfig config = reverse_preset(ReversePreset::kPaper);
  config.control_weight = 1e-3;
  config.robot_weight = 0.2;
  config.plain_barrier = 0.02;
  config.sharpness = config.torque_factor = 0.0;
  config.robot_density = 1.0;
  return config;
}

TEST(MeritSqp, EveryIterationLowersTheMeritAndKeepsToTheSafeguard) {
  expect_descent(PaperScene(small_weights()), 15);  // full steps would break the safeguard
  expect_descent(FreeRobot(small_weights()), 80);   // and here, from the 58th on, raise the merit
  expect_descent(PaperScene(reverse_preset(ReversePreset::kPaper)), 15);
}

TEST(MeritSqp, IteratesEndInTheGivenStateWithTheForcesOfTheirGaps) {
  PaperScene scene;
  const ReverseProblem problem = scene.problem();
  const Iterate x = iterates(scene, 5).back();
  EXPECT_NE(x.p[0], problem.end);
  EXPECT_EQ(x.p.back(), problem.end);
  for (std::size_t k = 0; k < x.p.size(); ++k) EXPECT_EQ(x.forces[k], scene.energy.forces(x.p[k]));
}

// The robot has just pushed the box by 1.2 m.
TEST(MeritSqp, AfterAPushInGatheringItDragsTheBoxBack) {
  PaperScene scene;
  const Scene& bodies = scene.task.scene;
  Poses before = scene.task.start;
  before[0] = {-3.0, -1.0, 0.0};
  constexpr int kUp = 12;
  scene.poses = forward::Box2dSimulator(bodies, scene.task.push, {}).push(before, kUp).end;
  ASSERT_GT(scene.poses[1].y, before[1].y + 1.0);
  scene.model(bodies);
  scene.push = direction(kUp, scene.task.push);
  const ReverseProblem problem = scene.problem();
  const SqpResult result = merit_sqp(problem, static_iterate(problem));
  ASSERT_EQ(result.status, SolveStatus::kConverged);
  const VectorXd moved = result.x.p[0] - problem.end;
  EXPECT_NEAR(moved[1], -longest_stride(scene.task.push), 0.2);  // of the robot
  EXPECT_NEAR(moved[4], moved[1], 0.05);
}

TEST(MeritSqp, EveryKktMethodTakesTheSameSteps) {
  PaperScene scene;
  scene.config.max_iterations = 5;
  const ReverseProblem problem = scene.problem();
  ASSERT_EQ(scene.config.kkt, KktMethod::kCyclicReduction);
  const SqpResult first = merit_sqp(problem, static_iterate(problem));
  ASSERT_EQ(first.status, SolveStatus::kIterationLimit);
  for (const KktMethod method :
       {KktMethod::kBlockElimination, KktMethod::kUmfpack, KktMethod::kKlu}) {
    scene.config.kkt = method;
    const SqpResult other = merit_sqp(problem, static_iterate(problem));
    ASSERT_EQ(other.status, SolveStatus::kIterationLimit);
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

TEST(MeritSqp, ReportsAStartThatIsNoLegalIterate) {
  const PaperScene scene;
  ReverseProblem problem = scene.problem();
  problem.end = energy::stacked({{0, 0, 0}, {40, 0, 0}, {40.9, 0.2, 0}});
  EXPECT_EQ(merit_sqp(problem, static_iterate(problem)).status, SolveStatus::kNonFinite);
}

TEST(MeritSqp, ReportsSingularSystems) {
  PaperScene scene;
  scene.scene.bodies[2].density = 1e25;
  scene.energy = energy::StepEnergy(scene.scene, scene.physics, scene.task.push);
  const ReverseProblem problem = scene.problem();
  EXPECT_EQ(merit_sqp(problem, static_iterate(problem)).status, SolveStatus::kSingular);
}

}  // namespace
}  // namespace rtg::reverse

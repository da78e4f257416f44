#include "core/reverse/problem/reverse_problem.hpp"

#include <gtest/gtest.h>

#include "core/reverse/problem/problem_lanes.hpp"
#include "tests/support/one_candidate.hpp"
#include "tests/support/touching_scene.hpp"

namespace rtg::reverse {
namespace {

using testing::disturbed;
using testing::TouchingScene;

/// A trajectory in contact, moved at random, forces those of its gaps.
Iterate near_contact(const ReverseProblem& problem) {
  Rng rng(1);
  Iterate x = disturbed(testing::in_contact(problem), 1e-3, rng);
  for (std::size_t k = 0; k < x.p.size(); ++k) x.forces[k] = problem.energy.forces(x.p[k]);
  x.forces[0] = problem.energy.start_forces(x.p[0]);
  return x;
}

/// (t̄₀, θ̄₀) after sub-step k.
Vector3d robot_path(const ReverseProblem& problem, int k) {
  ProblemLanes<double> lanes(problem);
  lanes.load(0, problem);
  return lanes.robot_path(k);
}

TEST(ReverseProblem, RobotPathIsStraightAndEndsInTheEnd) {
  const TouchingScene scene;
  const ReverseConfig config;
  ReverseProblem problem = scene.problem(config);
  problem.direction = {0.6, 0.8};
  problem.end.head<3>() = Vector3d(1, 2, 0.3);
  EXPECT_LT((robot_path(problem, 10) - Vector3d(1, 2, 0.3)).norm(), 1e-15);
  EXPECT_LT((robot_path(problem, 0) - Vector3d(1 - 1.2, 2 - 1.6, 0.3)).norm(), 1e-15);
  EXPECT_LT((robot_path(problem, 4) - Vector3d(1 - 0.72, 2 - 0.96, 0.3)).norm(), 1e-15);
  problem.pace = 0.5;
  EXPECT_LT((robot_path(problem, 4) - Vector3d(1 - 0.36, 2 - 0.48, 0.3)).norm(), 1e-15);
}

TEST(ReverseProblem, StaticIterateRestsInTheEnd) {
  const TouchingScene scene;
  const ReverseConfig config;
  const ReverseProblem problem = scene.problem(config);
  const Iterate x = static_iterate(problem);
  ASSERT_EQ(x.p.size(), 11u);
  for (std::size_t k = 0; k < x.p.size(); ++k) {
    EXPECT_EQ(x.p[k], problem.end);
    EXPECT_EQ(x.forces[k],
              k == 0 ? scene.energy.start_forces(problem.end) : scene.energy.forces(problem.end));
    EXPECT_EQ(x.controls[k], Vector3d(Vector3d::Zero()));
  }
}

// Φ_k = ∂Ψ/∂p₊, which StepEnergy computes by itself, less the robot's force.
TEST(ReverseProblem, ResidualsAreTheStepEnergysGradients) {
  const TouchingScene scene;
  const ReverseConfig config;
  const ReverseProblem problem = scene.problem(config);
  const Iterate x = near_contact(problem);
  const Violation v = violation(problem, x);
  for (std::size_t k = 1; k < x.p.size(); ++k) {
    VectorXd expected = scene.energy.model(x.p[k], {x.p[k - 1], x.forces[k - 1]}).gradient;
    const Vector3d push = x.controls[k].array().tanh();
    expected.head<3>() -= scene.energy.control_bound().cwiseProduct(push);
    EXPECT_LT((v.residuals[k] - expected).norm(), 1e-14) << k;
    EXPECT_LT(v.complementarity[k].lpNorm<Eigen::Infinity>(), 1e-16) << k;
  }
}

TEST(ReverseProblem, AForceTooLargeViolatesComplementarityByItselfTimesTheGap) {
  const TouchingScene scene;
  const ReverseConfig config;
  const ReverseProblem problem = scene.problem(config);
  Iterate x = near_contact(problem);
  Eigen::Index contact = 0;
  ASSERT_GT(x.forces[5].maxCoeff(&contact), 0.0);
  x.forces[5][contact] += 0.01;
  const double gap =
      scene.energy.gap_value(scene.energy.contacts()[static_cast<std::size_t>(contact)], x.p[5]);
  EXPECT_NEAR(violation(problem, x).complementarity[5][contact], 0.01 * gap, 1e-15);
}

TEST(ReverseProblem, NormsOfTheViolationCountBothKinds) {
  Violation v;
  v.residuals = {VectorXd{{0, 0}}, VectorXd{{1, -2}}};
  v.complementarity = {VectorXd{{-4, 0.5}}, VectorXd()};
  EXPECT_DOUBLE_EQ(v.l1(), 7.5);
  EXPECT_DOUBLE_EQ(v.max(), 4.0);
}

// Nothing near anything: eq. (6), path and spring by hand.
TEST(ReverseProblem, ObjectiveIsTheSumOfItsTerms) {
  const TouchingScene scene;
  ReverseConfig config;
  config.robot_weight = 0.25;
  config.object_weight = 0.75;
  config.path_weight = 3.0;
  config.heading_weight = 5.0;
  config.speed_weight = 0.0;
  ReverseProblem problem = scene.problem(config);
  problem.end = energy::stacked({{0, 0, 0}, {20, 0, 0}, {0, 20, 0}});
  Iterate x = static_iterate(problem);
  for (int k = 0; k <= 10; ++k) x.p[static_cast<std::size_t>(k)].head<3>() = robot_path(problem, k);
  EXPECT_NEAR(objective(problem, x), -config.robot_weight * 2.0, 1e-14);
  x.p[0][3] -= 0.5;  // box 1 further back
  x.p[3][1] += 0.1;  // robot beside its path, and turned
  x.p[4][2] += 0.2;
  x.controls[7] = Vector3d(1, 2, -2);
  x.p[10][6] += 0.3;  // box 2 ends elsewhere
  EXPECT_NEAR(objective(problem, x),
              -config.robot_weight * 2.0 - config.object_weight * 0.5 + 3.0 * 0.01 + 5.0 * 0.04 +
                  config.control_weight * 9.0 + 0.5 * config.terminal_weight * 0.09,
              1e-12);
  EXPECT_NEAR(terminal_miss(problem, x), 0.3, 1e-15);
}

// Where bodies coast, the final state prescribes their speed as well, so two levels.
TEST(ReverseProblem, InDynamicModeTheSpringHoldsTheLastTwoLevels) {
  const testing::CoastingScene scene;
  ReverseConfig config;
  config.speed_weight = 0.0;
  const ReverseProblem problem = scene.problem(config);
  const Iterate rest = static_iterate(problem);
  const std::size_t last = rest.p.size() - 1;
  for (const std::size_t k : {last, last - 1, last - 2}) {
    Iterate x = rest;
    x.p[k][7] += 0.3;
    const double expected = k < last - 1 ? 0.0 : 0.5 * config.terminal_weight * 0.09;
    EXPECT_NEAR(objective(problem, x) - objective(problem, rest), expected, 1e-12) << last - k;
  }
}

TEST(ReverseProblem, ObjectsPayForTheirSpeedTheRobotDoesNot) {
  const TouchingScene scene;
  ReverseConfig config;
  config.speed_weight = 0.7;
  ReverseProblem problem = scene.problem(config);
  problem.end = energy::stacked({{0, 0, 0}, {20, 0, 0}, {0, 20, 0}});
  Iterate x = static_iterate(problem);
  for (int k = 0; k <= 10; ++k) x.p[static_cast<std::size_t>(k)].head<3>() = robot_path(problem, k);
  const double before = objective(problem, x), stride = scene.energy.stride();
  for (std::size_t k = 0; k < 5; ++k) x.p[k][4] += 2.0 * stride;  // box 1, in one sub-step
  EXPECT_NEAR(objective(problem, x) - before, 0.7 * 8.0, 1e-12);
}

TEST(ReverseProblem, ObjectiveHoldsTheBarrierOfTheStart) {
  const TouchingScene scene;
  ReverseConfig config;
  config.speed_weight = 0.0;
  const ReverseProblem problem = scene.problem(config);
  const Iterate touching = static_iterate(problem);
  Iterate apart = touching;
  apart.p[0][7] += 10.0;  // across the push, where it costs nothing else
  double barrier = 0.0;
  for (const energy::Contact& c : scene.energy.contacts())
    if (c.body == 2 || c.other == 2)
      barrier += scene.energy.barrier().value(scene.energy.gap_value(c, problem.end));
  EXPECT_GT(barrier, 0.0);
  EXPECT_NEAR(objective(problem, touching) - objective(problem, apart), barrier, 1e-12);
}

}  // namespace
}  // namespace rtg::reverse

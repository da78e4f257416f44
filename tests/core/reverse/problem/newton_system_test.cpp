#include "core/reverse/problem/newton_system.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/first_order_conditions.hpp"
#include "tests/support/one_candidate.hpp"
#include "tests/support/touching_scene.hpp"

namespace rtg::reverse {
namespace {

using testing::CoastingScene;
using testing::conditions;
using testing::Curvature;
using testing::Direction;
using testing::directions;
using testing::disturbed;
using testing::expect_matrix_is_derivative;
using testing::expect_right_hand_side_is_gradient;
using testing::expect_step_solves_the_constraints;
using testing::Linearisation;
using testing::moved;
using testing::nothing;
using testing::solution_of;
using testing::TouchingScene;

TEST(NewtonSystem, MatrixIsDerivativeOfFirstOrderConditions) {
  TouchingScene scene;
  const ReverseConfig config;
  const ReverseProblem problem = scene.problem(config);
  Rng rng(1);
  expect_matrix_is_derivative(problem, disturbed(testing::in_contact(problem), 1e-3, rng));
}

TEST(NewtonSystem, MatrixIsDerivativeOfRoundAndCompoundBodies) {
  testing::RoundScene scene;
  const ReverseConfig config;
  const ReverseProblem problem = scene.problem(config);
  Rng rng(1);
  expect_matrix_is_derivative(problem, disturbed(testing::in_contact(problem), 1e-3, rng));
}

TEST(NewtonSystem, MatrixIsDerivativeWithInertia) {
  CoastingScene scene;
  const ReverseConfig config;
  const ReverseProblem problem = scene.problem(config);
  Rng rng(1);
  expect_matrix_is_derivative(problem, disturbed(static_iterate(problem), 1e-3, rng));
}

// Bodies far apart that turn by up to 0.5 rad per sub-step; entry by entry, as what the sine adds
// to the curvature is small beside the largest.
void expect_columns_are_derivatives(TouchingScene scene) {
  scene.physics.periodic_turns = true;
  scene.physics.sub_steps = 4;
  scene.update();
  scene.poses = {{0.0, 0.0, 0.0}, {5.0, 0.0, 0.0}, {0.0, 5.0, 0.0}};
  const ReverseConfig config;
  const ReverseProblem problem = scene.problem(config);
  Rng rng(2);
  const Iterate x = disturbed(static_iterate(problem), 0.25, rng);
  const Linearisation lin(problem, x, {true, 0.0});
  for (std::size_t block = 0; block < lin.matrix().A.size(); ++block)
    for (Eigen::Index row = 0; row < lin.matrix().A[block].rows(); ++row) {
      BlockVector along = nothing(lin);
      along[block][row] = 1.0;
      const Direction d = lin.direction(along, false);
      const double t = 1e-5;
      const VectorXd difference = (conditions(problem, moved(problem, x, d, t)) -
                                   conditions(problem, moved(problem, x, d, -t))) /
                                  (2.0 * t);
      const VectorXd column = joined(product(lin.matrix(), along));
      EXPECT_LT((difference - column).lpNorm<Eigen::Infinity>(), 1e-6) << block << ", " << row;
    }
}

TEST(NewtonSystem, MatrixIsDerivativeWithPeriodicTurns) {
  expect_columns_are_derivatives(TouchingScene());
}

TEST(NewtonSystem, MatrixIsDerivativeWithPeriodicTurnsAndInertia) {
  expect_columns_are_derivatives(CoastingScene());
}

TEST(NewtonSystem, MatrixIsDerivativeWithFixedEnd) {
  TouchingScene scene;
  ReverseConfig config;
  config.terminal_weight = 0.0;
  const ReverseProblem problem = scene.problem(config);
  Rng rng(3);
  Iterate x = disturbed(static_iterate(problem), 1e-3, rng);
  x.p.back() = problem.end;
  expect_matrix_is_derivative(problem, x);
}

/// Touching scene, disturbed from its solution, with random multipliers.
struct Disturbed {
  TouchingScene scene;
  ReverseConfig config;
  ReverseProblem problem = scene.problem(config);
  Iterate x;

  explicit Disturbed(std::uint64_t seed) {
    Rng rng(seed);
    x = disturbed(testing::in_contact(problem), 1e-3, rng);
  }
};

TEST(NewtonSystem, RightHandSideIsMinusTheGradientOfTheLagrangian) {
  const Disturbed at(4);
  expect_right_hand_side_is_gradient(at.problem, at.x);
}

void expect_stationarity_is_largest_gradient(const ReverseProblem& problem, const Iterate& x) {
  const Linearisation lin(problem, x, {true, 0.0});
  const BlockVector r = lin.conditions();
  double largest = r[0].lpNorm<Eigen::Infinity>();
  for (std::size_t k = 1; k < r.size(); ++k)
    largest = std::max(largest, r[k].head(9 + 3).lpNorm<Eigen::Infinity>());
  EXPECT_DOUBLE_EQ(lin.newton().stationarity(), largest);
}

TEST(NewtonSystem, StationarityIsTheLargestGradientOfThePrimalUnknowns) {
  const Disturbed at(6);
  expect_stationarity_is_largest_gradient(at.problem, at.x);
  for (int m = 0; m < 3; ++m) {
    Iterate x = at.x;
    x.controls[4][m] += 1e7;
    expect_stationarity_is_largest_gradient(at.problem, x);
    const Linearisation lin(at.problem, x, {true, 0.0});
    EXPECT_EQ(lin.newton().stationarity(), std::abs(lin.conditions()[4][9 + m]));
  }
}

// Bodies far apart: with a large multiplier of the motion along one coordinate, the largest
// gradient is over that one.
TEST(NewtonSystem, StationarityIsOverPositionsAndAngles) {
  TouchingScene scene;
  scene.poses = {{0.0, 0.0, 0.0}, {5.0, 0.0, 0.0}, {0.0, 5.0, 0.0}};
  const ReverseConfig config;
  const ReverseProblem problem = scene.problem(config);
  for (int m = 3; m < 9; ++m) {
    Iterate x = static_iterate(problem);
    x.multipliers[4][m] = 1e7;
    expect_stationarity_is_largest_gradient(problem, x);
    const VectorXd r = Linearisation(problem, x, {true, 0.0}).conditions()[4].head(9 + 3);
    Eigen::Index largest = 0;
    r.cwiseAbs().maxCoeff(&largest);
    EXPECT_EQ(largest, m);
  }
}

TEST(NewtonSystem, StepSolvesTheLinearisedConstraints) {
  const Disturbed at(7);
  expect_step_solves_the_constraints(at.problem, at.x, 1e-6, 1e-6);
}

TEST(NewtonSystem, ObjectiveSlopeMatchesDifferences) {
  const Disturbed at(8);
  const Linearisation lin(at.problem, at.x, {});
  const Direction d = lin.direction(solution_of(lin), true);
  const double t = 1e-6, slope = lin.newton().objective_slope(lin.lanes(), lin.trajectory(),
                                                              lin.step(solution_of(lin)));
  EXPECT_NEAR((objective(at.problem, moved(at.problem, at.x, d, t)) -
               objective(at.problem, moved(at.problem, at.x, d, -t))) /
                  (2.0 * t),
              slope, 1e-6 * std::abs(slope) + 1e-7);  // K has -1e-9 on the multipliers
}

/// |Δp|² + |Δc|² + 0.01 |Δλ|² of the step that s + t·u stands for.
double step_size(const Linearisation& lin, BlockVector s, const BlockVector& u, double t) {
  for (std::size_t k = 0; k < s.size(); ++k) s[k] += t * u[k];
  const Direction d = lin.direction(s, true);
  double sum = 0.0;
  for (std::size_t k = 0; k < d.p.size(); ++k)
    sum += d.p[k].squaredNorm() + d.controls[k].squaredNorm() + 0.01 * d.forces[k].squaredNorm();
  return sum;
}

// Newton's equations K s = r with it, less those without. The forces follow from the poses and from
// how far complementarity is from holding.
TEST(NewtonSystem, ProximalTermIsTheGradientOfTheSquaredStep) {
  const Disturbed at(10);
  const double proximal = 0.7;
  for (const bool lagrangian : {false, true}) {
    const Linearisation with(at.problem, at.x, {lagrangian, proximal});
    const Linearisation without(at.problem, at.x, {lagrangian, 0.0});
    const auto left = [](const Linearisation& lin, const BlockVector& s) {
      return VectorXd(joined(product(lin.matrix(), s)) - joined(lin.right_hand_side()));
    };
    const std::vector<BlockVector> all = directions(with);
    const VectorXd term = left(with, all[0]) - left(without, all[0]);
    for (const BlockVector& u : all) {
      const double slope =
          0.25 * proximal * (step_size(with, all[0], u, 1.0) - step_size(with, all[0], u, -1.0));
      EXPECT_NEAR(term.dot(joined(u)), slope, 1e-9 * std::abs(slope));
    }
  }
}

/// Curvature along the primal part of a vector of the system.
double curvature(const Linearisation& lin, const BlockVector& solution) {
  StageStep<double> primal = lin.step(solution);
  for (BlockColumn<double>& y : primal.multipliers)
    for (Vec3<double>& block : y) block.setZero();
  const BlockVector s = lin.assembled().written(primal);
  return joined(s).dot(joined(product(lin.matrix(), s)));
}

TEST(NewtonSystem, ModelCurvatureIsThatAlongTheStep) {
  const Disturbed at(9);
  for (const bool lagrangian : {false, true}) {
    const Linearisation lin(at.problem, at.x, {lagrangian, 0.3});
    const BlockVector s = solution_of(lin);
    const double expected = curvature(lin, s);
    EXPECT_NEAR(lin.newton().model_curvature(lin.step(s)), expected,
                1e-5 * std::abs(expected) + 1e-7);
  }
}

// Controls enter the objective as ε |c|² alone.
TEST(NewtonSystem, CurvatureOfTheControlsIsThatOfTheObjectiveAndTheProximalTerm) {
  const Disturbed at(9);
  const double proximal = 0.3;
  const Linearisation lin(at.problem, at.x, {false, proximal});
  BlockVector along = nothing(lin);
  along[3].segment<3>(9) = Vector3d(1.0, -2.0, 2.0);
  EXPECT_NEAR(curvature(lin, along), 9.0 * (2.0 * at.config.control_weight + proximal), 1e-12);
}

}  // namespace
}  // namespace rtg::reverse

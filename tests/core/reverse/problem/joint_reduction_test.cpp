#include "core/reverse/problem/joint_reduction.hpp"

#include "tests/support/first_order_conditions.hpp"
#include "tests/support/one_candidate.hpp"

namespace rtg::reverse {
namespace {

using testing::ChainScene;
using testing::Direction;
using testing::directions;
using testing::expect_matrix_is_derivative;
using testing::expect_right_hand_side_is_gradient;
using testing::expect_step_solves_the_constraints;
using testing::Linearisation;
using testing::moved;
using testing::solution_of;

/// The chain at rest, disturbed, with random multipliers; all jointed bodies follow.
struct Disturbed {
  ChainScene scene;
  ReverseConfig config;
  ReverseProblem problem;
  Iterate x;

  explicit Disturbed(std::uint64_t seed, const PhysicsConfig& physics = {})
      : scene(with(physics)), problem(scene.problem(config)) {
    Rng rng(seed);
    x = static_iterate(problem);
    const Linearisation at_rest(problem, x, {true, 1.0});
    const Direction d = at_rest.direction(directions(at_rest)[0], true);
    x = moved(problem, x, d, 2e-3);
    for (VectorXd& y : x.multipliers) y = testing::noise(y.size(), 1.0, rng);
    x = moved(problem, x, d, 0.0);
  }

  static ChainScene with(const PhysicsConfig& physics) {
    ChainScene scene;
    scene.physics = physics;
    scene.update();
    return scene;
  }
};

TEST(JointReduction, MatrixIsDerivativeOfFirstOrderConditions) {
  const Disturbed at(1);
  ASSERT_GT(at.x.forces[3].tail(6).maxCoeff(), 0.0);  // a joint at its limit
  expect_matrix_is_derivative(at.problem, at.x);
}

TEST(JointReduction, MatrixIsDerivativeWithInertia) {
  PhysicsConfig physics;
  physics.inertia = physics.periodic_turns = true;
  physics.damping = 2.0;
  const Disturbed at(2, physics);
  expect_matrix_is_derivative(at.problem, at.x);
}

TEST(JointReduction, MatrixIsDerivativeWithFixedEnd) {
  Disturbed at(6);
  at.config.terminal_weight = 0.0;
  at.x.p.back() = at.problem.end;
  at.x.multipliers.back() =
      testing::apply_jacobian(at.scene.energy, at.problem.end, at.x.multipliers.back());
  expect_matrix_is_derivative(at.problem, at.x);
}

TEST(JointReduction, RightHandSideIsMinusTheGradientOfTheLagrangian) {
  const Disturbed at(3);
  expect_right_hand_side_is_gradient(at.problem, at.x);
}

TEST(JointReduction, StepSolvesTheLinearisedConstraints) {
  const Disturbed at(4);
  expect_step_solves_the_constraints(at.problem, at.x, 1e-7, 1e-5);
}

TEST(JointReduction, EntriesThatBelongToNoCoordinateDoNotMove) {
  const Disturbed at(5);
  const Linearisation lin(at.problem, at.x, {true, 0.1});
  const StageStep<double> step = lin.step(solution_of(lin));
  for (std::size_t k = 0; k < step.poses.size(); ++k)
    for (const int child : {1, 3, 4}) {
      EXPECT_LT(step.poses[k][static_cast<std::size_t>(child)].head<2>().norm(), 1e-12);
      EXPECT_GT(std::abs(step.poses[k][static_cast<std::size_t>(child)][2]), 0.0);
    }
}

}  // namespace
}  // namespace rtg::reverse

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
using testing::SliderScene;
using testing::solution_of;

/// A scene at rest, disturbed, with random multipliers; all jointed bodies follow.
template <class Scene>
struct Disturbed {
  Scene scene;
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

  static Scene with(const PhysicsConfig& physics) {
    Scene scene;
    scene.physics = physics;
    scene.update();
    return scene;
  }
};

template <class Scene>
class JointReductionTest : public ::testing::Test {};
using Scenes = ::testing::Types<ChainScene, SliderScene>;
TYPED_TEST_SUITE(JointReductionTest, Scenes);

TYPED_TEST(JointReductionTest, MatrixIsDerivativeOfFirstOrderConditions) {
  const Disturbed<TypeParam> at(1);
  ASSERT_GT(at.x.forces[3].tail(2 * at.scene.scene.joints.size()).maxCoeff(),
            0.0);  // a joint at its limit
  expect_matrix_is_derivative(at.problem, at.x);
}

TYPED_TEST(JointReductionTest, MatrixIsDerivativeWithInertia) {
  PhysicsConfig physics;
  physics.inertia = physics.periodic_turns = true;
  physics.damping = 2.0;
  const Disturbed<TypeParam> at(2, physics);
  expect_matrix_is_derivative(at.problem, at.x);
}

TYPED_TEST(JointReductionTest, MatrixIsDerivativeWithFixedEnd) {
  Disturbed<TypeParam> at(6);
  at.config.terminal_weight = 0.0;
  const VectorXd y =
      testing::to_coordinates(at.scene.energy, at.x.p.back(), at.x.multipliers.back());
  at.x.p.back() = at.problem.end;
  at.x.multipliers.back() = testing::apply_jacobian(at.scene.energy, at.problem.end, y);
  expect_matrix_is_derivative(at.problem, at.x);
}

TYPED_TEST(JointReductionTest, RightHandSideIsMinusTheGradientOfTheLagrangian) {
  const Disturbed<TypeParam> at(3);
  expect_right_hand_side_is_gradient(at.problem, at.x);
}

TYPED_TEST(JointReductionTest, StepSolvesTheLinearisedConstraints) {
  const Disturbed<TypeParam> at(4);
  expect_step_solves_the_constraints(at.problem, at.x, 1e-7, 1e-5);
}

TYPED_TEST(JointReductionTest, EntriesThatBelongToNoCoordinateDoNotMove) {
  const Disturbed<TypeParam> at(5);
  const Linearisation lin(at.problem, at.x, {true, 0.1});
  const StageStep<double> step = lin.step(solution_of(lin));
  for (const BlockColumn<double>& poses : step.poses)
    for (const Joint& joint : at.scene.scene.joints)
      for (int m = 0; m < 3; ++m) {
        const double moved = std::abs(poses[static_cast<std::size_t>(joint.child)][m]);
        if (m == energy::slot_of(joint.type)) {
          EXPECT_GT(moved, 0.0);
        } else {
          EXPECT_LT(moved, 1e-12);
        }
      }
}

}  // namespace
}  // namespace rtg::reverse

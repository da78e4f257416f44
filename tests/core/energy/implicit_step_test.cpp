#include "core/energy/implicit_step.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "tests/support/differences.hpp"
#include "tests/support/linearisation.hpp"
#include "tests/support/touching_scene.hpp"

namespace rtg::energy {
namespace {

using testing::noise;
using testing::TouchingScene;

const Vector3d kControl(0.3, -0.2, 0.1);

/// Everything far from everything else.
VectorXd scattered() { return stacked({{0, 0, 0.4}, {5, 0, 0.1}, {0, 5, 0.2}}); }

VectorXd step(const StepEnergy& energy, const VectorXd& now, const Drive<double>& drive) {
  const auto result = implicit_step(energy, {now, energy.forces(now)}, drive);
  EXPECT_TRUE(result);
  return result ? result->next : now;
}

// m (t₊ - t) = B_f tanh(f), J (θ₊ - θ) = B_ω tanh(τ).
TEST(ImplicitStep, FreePushIsTheClosedForm) {
  const TouchingScene scene;
  const Damping<double>& robot = scene.energy.damping(0);
  const Vector3d push = scene.energy.control_bound().array() * kControl.array().tanh();
  const VectorXd moved =
      step(scene.energy, scattered(), Drive<double>::controls(kControl)) - scattered();
  EXPECT_NEAR(moved[0], push[0] / robot.mass, 1e-10);
  EXPECT_NEAR(moved[1], push[1] / robot.mass, 1e-10);
  EXPECT_NEAR(moved[2], push[2] / robot.moment, 1e-10);
  EXPECT_EQ(moved.tail(6), VectorXd::Zero(6));
}

TEST(ImplicitStep, FreeTurnWithPeriodicDampingIsTheArcSine) {
  TouchingScene scene;
  scene.physics.periodic_turns = true;
  const StepEnergy energy(scene.scene, scene.physics, scene.task.push);
  const double torque = energy.control_bound()[2] * std::tanh(0.1);
  const VectorXd moved =
      step(energy, scattered(), Drive<double>::controls({0, 0, 0.1})) - scattered();
  EXPECT_NEAR(moved[2], std::asin(torque / energy.damping(0).moment), 1e-9);
}

/// The Δ for which `resistance` Δ = bound tanh((e - Δ)/scale), by bisection.
double servo_advance(double resistance, double bound, double scale, double e) {
  double low = 0.0, high = e;
  for (int k = 0; k < 100; ++k) {
    const double middle = 0.5 * (low + high);
    (resistance * middle < bound * std::tanh((e - middle) / scale) ? low : high) = middle;
  }
  return low;
}

TEST(ImplicitStep, FreeServoBalancesDampingAgainstItsForce) {
  const TouchingScene scene;
  const Vector3d bound = scene.energy.control_bound();
  const Vector3d scale = Vector3d::Constant(servo_scale(scene.energy.stride()));
  for (const double e : {0.01, 0.2, 5.0}) {  // beyond reach the force saturates
    const Vector3d target(e, 0.0, 0.4);
    const auto result = implicit_step(scene.energy, {scattered(), VectorXd::Zero(28)},
                                      Drive<double>::towards(target));
    ASSERT_TRUE(result);
    const double advance = servo_advance(scene.energy.damping(0).mass, bound[0], scale[0], e);
    EXPECT_NEAR(result->next[0], advance, 1e-9);
    EXPECT_NEAR(result->control[0], (e - advance) / scale[0], 1e-6);
    EXPECT_NEAR(result->next[2], 0.4, 1e-9);
  }
}

TEST(ImplicitStep, TheServosControlsLeadToTheSameEnd) {
  const TouchingScene scene;
  const VectorXd now = stacked(scene.poses);
  const auto servo = implicit_step(scene.energy, {now, scene.energy.forces(now)},
                                   Drive<double>::towards({0.2, 0.01, 0.0}));
  ASSERT_TRUE(servo);
  EXPECT_LT((step(scene.energy, now, Drive<double>::controls(servo->control)) - servo->next).norm(),
            1e-8);
}

TEST(ImplicitStep, EndsWhereTheGradientVanishesAndEnergyIsLeast) {
  const TouchingScene scene;
  const VectorXd now = stacked(scene.poses), previous_forces = scene.energy.forces(now);
  const Vector3d bound = scene.energy.control_bound();
  const auto total = [&](const VectorXd& p) {
    return scene.energy.value(p, {now, previous_forces}) -
           bound.dot(kControl.array().tanh().matrix().cwiseProduct(p.head<3>()));
  };
  const VectorXd end = step(scene.energy, now, Drive<double>::controls(kControl));
  EXPECT_GT((end - now).segment<3>(3).norm(), 1e-3);  // the box was pushed
  Rng rng(1);
  for (int trial = 0; trial < 20; ++trial) EXPECT_GT(total(end + noise(9, 1e-3, rng)), total(end));
  VectorXd residual = scene.energy.model(end, {now, previous_forces}).gradient;
  residual.head<3>() -= bound.cwiseProduct(kControl.array().tanh().matrix());
  EXPECT_LT(residual.lpNorm<Eigen::Infinity>(), 1e-10);
}

// Without the robot nothing drives the bodies: the sum of m Δt over all of them stays what the
// robot's force makes it, B tanh(c).
TEST(ImplicitStep, MomentumComesFromTheRobotsForceAlone) {
  const TouchingScene scene;
  const VectorXd now = stacked(scene.poses);
  const VectorXd moved = step(scene.energy, now, Drive<double>::controls(kControl)) - now;
  Vector2d momentum = Vector2d::Zero();
  for (int i = 0; i < 3; ++i) momentum += scene.energy.damping(i).mass * moved.segment<2>(3 * i);
  const Vector3d force = scene.energy.control_bound().array() * kControl.array().tanh();
  EXPECT_LT((momentum - force.head<2>()).norm(), 1e-9);
}

/// ∂Φ/∂p₊, ∂Φ/∂p and ∂Φ/∂c of a sub-step, as the reverse solver's Newton system has them.
struct ResidualJacobians {
  MatrixXd next, now, control;
};

ResidualJacobians residual_jacobians(const reverse::ReverseProblem& problem,
                                     const reverse::Iterate& x) {
  const int n = problem.energy.dofs();
  const BlockTridiagonal K = testing::Linearisation(problem, x, {false, 0.0}).matrix();
  const MatrixXd rows = K.A[1].bottomRows(n);
  return {rows.leftCols(n), K.B[1].bottomRows(n), rows.middleCols(n, 3)};
}

// ∂p₊/∂p = -Φ₊⁻¹ Φ_p and ∂p₊/∂c = -Φ₊⁻¹ Φ_c, against steps solved again. Φ_p holds the derivative
// of the lagged normal forces.
TEST(ImplicitStep, DerivativesOfTheEndMatchStepsSolvedAgain) {
  const TouchingScene scene;
  const reverse::ReverseConfig config;
  reverse::ReverseProblem problem = scene.problem(config);
  problem.sub_steps = 1;
  const Vector3d target(0.2, 0.01, 0.02);
  reverse::Iterate x = static_iterate(problem);
  const auto first =
      implicit_step(scene.energy, {problem.end, x.forces[0]}, Drive<double>::towards(target));
  ASSERT_TRUE(first);
  x.p[1] = first->next;
  x.controls[1] = first->control;
  x.forces[1] = scene.energy.forces(x.p[1]);
  const ResidualJacobians J = residual_jacobians(problem, x);
  const Eigen::PartialPivLU<MatrixXd> lu(J.next);
  const auto end = [&](const VectorXd& p, const Vector3d& controls) {
    const auto found = implicit_step(scene.energy, {p, scene.energy.start_forces(p)},
                                     Drive<double>::controls(controls));
    EXPECT_TRUE(found);
    return found ? found->next : p;
  };
  const auto end_from = [&](const VectorXd& p) { return end(p, x.controls[1]); };
  const auto end_by = [&](const VectorXd& c) { return end(x.p[0], c); };
  Rng rng(2);
  const MatrixXd by_now = -lu.solve(J.now), by_control = -lu.solve(J.control);
  EXPECT_LT(testing::derivative_error(end_from, by_now, x.p[0],
                                      testing::test_directions(by_now.row(3), rng)),
            2e-4);
  EXPECT_LT(testing::derivative_error(end_by, by_control, x.controls[1],
                                      testing::test_directions(by_control.row(3), rng)),
            2e-4);
}

TEST(ImplicitStep, ImpossibleStartsGiveNothing) {
  const TouchingScene scene;
  const VectorXd overlapping = stacked({{0, 0, 0}, {1.0, 0, 0}, {5, 0, 0}});
  EXPECT_FALSE(implicit_step(scene.energy, {overlapping, VectorXd::Zero(28)},
                             Drive<double>::controls(Vector3d::Zero())));
  VectorXd nan = scattered();
  nan[1] = NAN;
  EXPECT_FALSE(implicit_step(scene.energy, {nan, VectorXd::Zero(28)},
                             Drive<double>::controls(Vector3d::Zero())));
  EXPECT_FALSE(implicit_step(scene.energy, {scattered(), VectorXd::Zero(28)},
                             Drive<double>::controls(Vector3d::Constant(NAN))));
}

}  // namespace
}  // namespace rtg::energy

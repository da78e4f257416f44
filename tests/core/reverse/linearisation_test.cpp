#include "core/reverse/linearisation.hpp"

#include <gtest/gtest.h>

#include "tests/support/touching_scene.hpp"

namespace rtg {
namespace {

using testing::disturbed;
using testing::noise;
using testing::TouchingScene;

/// x moved by t along d.
Iterate moved(Iterate x, const Direction& d, double t) {
  for (std::size_t k = 0; k < x.p.size(); ++k) {
    x.p[k] += t * d.p[k];
    x.forces[k] += t * d.forces[k];
    x.controls[k] += t * d.controls[k];
    x.multipliers[k] += t * d.multipliers[k];
  }
  return x;
}

/// The first-order conditions (∇L; Φ) with complementarity left out.
VectorXd conditions(const ReverseProblem& problem, const Iterate& x) {
  const Linearisation lin(problem, x, {true, 0.0});
  Violation v = lin.violation();
  for (VectorXd& c : v.complementarity) c.setZero();
  return -joined(lin.right_hand_side(v));
}

/// The system's matrix against central differences of the first-order conditions along random
/// directions on which the forces follow the gaps (Δλ = b·Δp).
void expect_matrix_is_derivative(const ReverseProblem& problem, const Iterate& x) {
  const Linearisation lin(problem, x, {true, 0.0});
  Violation none = lin.violation();
  for (VectorXd& c : none.complementarity) c.setZero();
  Rng rng(5);
  for (int trial = 0; trial < 5; ++trial) {
    BlockVector along;
    for (const MatrixXd& A : lin.matrix().A) along.push_back(noise(A.rows(), 1.0, rng));
    const Direction d = lin.direction(along, none);
    const double t = 1e-7;
    const VectorXd difference =
        (conditions(problem, moved(x, d, t)) - conditions(problem, moved(x, d, -t))) / (2.0 * t);
    const VectorXd product = joined(rtg::product(lin.matrix(), along));
    EXPECT_LT((difference - product).lpNorm<Eigen::Infinity>(),
              1e-5 * product.lpNorm<Eigen::Infinity>());
  }
}

TEST(Linearisation, MatrixIsDerivativeOfFirstOrderConditions) {
  TouchingScene scene;
  const ReverseConfig config;
  const ReverseProblem problem = scene.problem(config);
  const auto start = warm_start(problem);
  ASSERT_TRUE(start);
  Rng rng(1);
  expect_matrix_is_derivative(problem, disturbed(*start, 1e-3, rng));
}

TEST(Linearisation, MatrixIsDerivativeWithPeriodicDamping) {
  TouchingScene scene;
  scene.physics.periodic_damping = true;
  scene.energy = StepEnergy(scene.scene, scene.physics, scene.task.push);
  const ReverseConfig config;
  const ReverseProblem problem = scene.problem(config);
  const auto start = warm_start(problem);
  ASSERT_TRUE(start);
  Rng rng(2);
  expect_matrix_is_derivative(problem, disturbed(*start, 1e-3, rng));
}

TEST(Linearisation, MatrixIsDerivativeWithFixedEnd) {
  TouchingScene scene;
  ReverseConfig config;
  config.terminal_weight = 0.0;
  const ReverseProblem problem = scene.problem(config);
  Rng rng(3);
  Iterate x = disturbed(static_iterate(problem), 1e-3, rng);
  x.p.back() = problem.end;
  expect_matrix_is_derivative(problem, x);
}

}  // namespace
}  // namespace rtg

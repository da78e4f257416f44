#include "core/math/kkt_solver.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <string>

#include "tests/support/gathering.hpp"
#include "tests/support/linearisation.hpp"
#include "tests/support/one_candidate.hpp"
#include "tests/support/touching_scene.hpp"

namespace rtg {
namespace {

using testing::noise;

constexpr KktMethod kMethods[] = {KktMethod::kBlockElimination, KktMethod::kCyclicReduction,
                                  KktMethod::kUmfpack, KktMethod::kKlu};

std::string name_of(KktMethod method) {
  return std::string(kKktMethods[static_cast<std::size_t>(method)]);
}

/// Random symmetric indefinite system of blocks of 1 to 6 unknowns; diagonal ±(4 ... 6) keeps it
/// well conditioned.
BlockTridiagonal random_system(std::size_t blocks, Rng& rng) {
  BlockTridiagonal K;
  for (std::size_t k = 0; k < blocks; ++k) {
    const int n = 1 + rng.below(6);
    const MatrixXd M = MatrixXd::NullaryExpr(n, n, [&] { return rng.uniform(-0.3, 0.3); });
    K.A.push_back(M + M.transpose());
    for (double& entry : K.A[k].diagonal())
      entry += rng.uniform(4.0, 6.0) * (rng.below(2) ? 1.0 : -1.0);
    const auto before = k == 0 ? 0 : K.A[k - 1].rows();
    K.B.push_back(
        MatrixXd::NullaryExpr(k == 0 ? 0 : n, before, [&] { return rng.uniform(-1.0, 1.0); }));
  }
  return K;
}

/// Backward error of the method's solution, ‖K x - r‖ / (‖K‖ ‖x‖ + ‖r‖).
double backward_error(KktSolver& solver, const BlockTridiagonal& K, const VectorXd& r) {
  if (!solver.factorize(K)) return INFINITY;
  const VectorXd x = joined(solver.solve(split_like(K, r)));
  return (K.dense() * x - r).norm() / (K.dense().norm() * x.norm() + r.norm());
}

class KktMethods : public ::testing::TestWithParam<KktMethod> {};

INSTANTIATE_TEST_SUITE_P(All, KktMethods, ::testing::ValuesIn(kMethods),
                         [](const auto& each) { return name_of(each.param); });

TEST_P(KktMethods, SolutionsAreThoseOfDenseLu) {
  const auto solver = make_kkt_solver(GetParam());
  Rng rng(1);
  for (const std::size_t blocks : {1, 2, 3, 4, 7, 8, 11, 16, 33}) {
    const BlockTridiagonal K = random_system(blocks, rng);
    const VectorXd r = noise(K.order(), 1.0, rng);
    ASSERT_TRUE(solver->factorize(K)) << blocks;
    const VectorXd expected = K.dense().fullPivLu().solve(r);
    EXPECT_LT((joined(solver->solve(split_like(K, r))) - expected).norm(), 1e-12 * expected.norm())
        << blocks;
  }
}

TEST_P(KktMethods, OneFactorisationServesSeveralRightHandSides) {
  const auto solver = make_kkt_solver(GetParam());
  Rng rng(2);
  const BlockTridiagonal K = random_system(11, rng);
  ASSERT_TRUE(solver->factorize(K));
  const VectorXd a = noise(K.order(), 1.0, rng), b = noise(K.order(), 1.0, rng);
  const VectorXd x = joined(solver->solve(split_like(K, a)));
  const VectorXd y = joined(solver->solve(split_like(K, b)));
  const VectorXd sum = joined(solver->solve(split_like(K, a + b)));
  EXPECT_LT((K.dense() * x - a).norm(), 1e-12);
  EXPECT_LT((K.dense() * y - b).norm(), 1e-12);
  EXPECT_LT((sum - x - y).norm(), 1e-12);
}

TEST_P(KktMethods, SingularAndNonFiniteSystemsAreReported) {
  const auto solver = make_kkt_solver(GetParam());
  Rng rng(3);
  for (const std::size_t blocks : {1, 2, 11}) {
    BlockTridiagonal K = random_system(blocks, rng);
    for (const std::size_t at : {std::size_t{0}, blocks - 1}) {
      BlockTridiagonal zero_row = K, nan = K;
      zero_row.A[at].row(0).setZero();
      zero_row.A[at].col(0).setZero();
      if (at > 0) zero_row.B[at].row(0).setZero();
      if (at + 1 < blocks) zero_row.B[at + 1].col(0).setZero();
      EXPECT_FALSE(solver->factorize(zero_row)) << blocks << " blocks, row of block " << at;
      nan.A[at](0, 0) = NAN;
      EXPECT_FALSE(solver->factorize(nan)) << blocks << " blocks, entry of block " << at;
    }
    EXPECT_LT(backward_error(*solver, K, noise(K.order(), 1.0, rng)), 1e-14);  // and recovers
  }
}

TEST_P(KktMethods, SystemsThatOnlyRoundingKeepsFromBeingSingularAreReported) {
  const auto solver = make_kkt_solver(GetParam());
  Rng rng(6);
  for (int trial = 0; trial < 20; ++trial) {
    BlockTridiagonal K = random_system(1, rng);
    const auto n = K.A[0].rows();
    MatrixXd M = MatrixXd::Identity(n, n + 1);
    M.col(n) = noise(n, 1.0, rng);
    K.A[0] = M.transpose() * K.A[0] * M;  // of rank n
    EXPECT_FALSE(solver->factorize(K)) << trial;
    K.A[0](n, n) += 1e-6;
    EXPECT_TRUE(solver->factorize(K)) << trial;
  }
}

/// Appends Newton systems of a solve: at the solution, disturbed, with the objective's Hessian and
/// the exact one, final state held by a spring and fixed.
void add_newton_systems(const testing::TouchingScene& scene,
                        std::vector<BlockTridiagonal>& systems) {
  Rng rng(4);
  for (const double terminal_weight : {300.0, 0.0}) {
    reverse::ReverseConfig config;
    config.terminal_weight = terminal_weight;
    const reverse::ReverseProblem problem = scene.problem(config);
    const reverse::Iterate x = testing::disturbed(testing::in_contact(problem), 1e-3, rng);
    for (const testing::Curvature curvature :
         {testing::Curvature{false, 1.0}, testing::Curvature{true, 1e-2}})
      systems.push_back(testing::Linearisation(problem, x, curvature).matrix());
  }
}

std::vector<BlockTridiagonal> newton_systems() {
  std::vector<BlockTridiagonal> systems;
  add_newton_systems(testing::TouchingScene(), systems);
  add_newton_systems(testing::CoastingScene(), systems);
  return systems;
}

// Condition numbers are up to 2e9, hence the wide tolerance on the solution itself.
TEST_P(KktMethods, NewtonSystemsOfAReverseSolveAreSolved) {
  const auto solver = make_kkt_solver(GetParam());
  Rng rng(5);
  for (const BlockTridiagonal& K : newton_systems()) {
    const VectorXd r = noise(K.order(), 1.0, rng);
    EXPECT_LT(backward_error(*solver, K, r), 1e-13);
    ASSERT_TRUE(solver->factorize(K));
    const VectorXd expected = K.dense().fullPivLu().solve(r);
    const VectorXd x = joined(solver->solve(split_like(K, r)));
    EXPECT_LT((x - expected).norm(), 1e-8 * expected.norm());
  }
}

// Six bodies in a row, nearly touching, with inertia. Cyclic reduction without refinement has a
// backward error of 1e-10 here.
TEST_P(KktMethods, SystemsWithInertiaAreSolvedToRounding) {
  const tasks::Task task = testing::gathering();
  PhysicsConfig physics;
  physics.inertia = true;
  const reverse::ReverseConfig config;
  const energy::StepEnergy energy(testing::row_of_boxes(6), physics, task.push);
  const reverse::ReverseProblem problem{energy, config, testing::row_poses(6), Vector2d::UnitX(),
                                        16};
  const testing::Linearisation lin(problem, static_iterate(problem), {true, 1.0});
  const BlockTridiagonal K = lin.matrix();
  EXPECT_EQ(K.blocks(), 17U);  // a block per sub-step
  EXPECT_LT(backward_error(*make_kkt_solver(GetParam()), K, joined(lin.right_hand_side())), 1e-14);
}

}  // namespace
}  // namespace rtg

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

/// A zero vector of the system.
BlockVector nothing(const Linearisation& lin) {
  BlockVector all;
  for (const MatrixXd& A : lin.matrix().A) all.push_back(VectorXd::Zero(A.rows()));
  return all;
}

/// Five random directions and that of the gradient, along which errors do not average out.
std::vector<BlockVector> directions(const Linearisation& lin, const Violation& v) {
  Rng rng(5);
  std::vector<BlockVector> all(5);
  for (BlockVector& along : all)
    for (const MatrixXd& A : lin.matrix().A) along.push_back(noise(A.rows(), 1.0, rng));
  all.push_back(lin.right_hand_side(v));
  const double size = joined(all.back()).lpNorm<Eigen::Infinity>();
  for (VectorXd& block : all.back()) block /= size;
  return all;
}

/// The system's matrix against central differences of the first-order conditions along directions
/// on which the forces follow the gaps (Δλ = b·Δp).
void expect_matrix_is_derivative(const ReverseProblem& problem, const Iterate& x) {
  const Linearisation lin(problem, x, {true, 0.0});
  Violation none = lin.violation();
  for (VectorXd& c : none.complementarity) c.setZero();
  for (const BlockVector& along : directions(lin, none)) {
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

// Bodies far apart that turn by up to 0.5 rad per sub-step; entry by entry, as what the sine adds
// to the curvature is small beside the largest.
TEST(Linearisation, MatrixIsDerivativeWithPeriodicDamping) {
  TouchingScene scene;
  scene.physics.periodic_damping = true;
  scene.energy = StepEnergy(scene.scene, scene.physics, scene.task.push);
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
      const Direction d = lin.direction(along, lin.violation());
      const double t = 1e-5;
      const VectorXd difference =
          (conditions(problem, moved(x, d, t)) - conditions(problem, moved(x, d, -t))) / (2.0 * t);
      const VectorXd column = joined(product(lin.matrix(), along));
      EXPECT_LT((difference - column).lpNorm<Eigen::Infinity>(), 1e-6) << block << ", " << row;
    }
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

/// Touching scene, disturbed from its warm start, with random multipliers.
struct Disturbed {
  TouchingScene scene;
  ReverseConfig config;
  ReverseProblem problem = scene.problem(config);
  Iterate x;

  explicit Disturbed(std::uint64_t seed) {
    Rng rng(seed);
    x = disturbed(*warm_start(problem), 1e-3, rng);
  }
};

/// J + Σ y·Φ.
double lagrangian(const ReverseProblem& problem, const Iterate& x) {
  const Violation v = violation(problem, x);
  double sum = objective(problem, x);
  for (std::size_t k = 1; k < x.p.size(); ++k) sum += x.multipliers[k].dot(v.residuals[k]);
  return sum;
}

// Along directions that keep complementarity (Δλ = b·Δp) its multipliers drop out.
TEST(Linearisation, RightHandSideIsMinusTheGradientOfTheLagrangian) {
  const Disturbed at(4);
  const Linearisation lin(at.problem, at.x, {true, 0.0});
  Violation v = lin.violation();
  for (VectorXd& c : v.complementarity) c.setZero();
  const VectorXd gradient = -joined(lin.right_hand_side(v));
  for (const BlockVector& along : directions(lin, v)) {
    const Direction d = lin.direction(along, v);
    const double t = 1e-7, slope = gradient.dot(joined(along));
    EXPECT_NEAR(
        (lagrangian(at.problem, moved(at.x, d, t)) - lagrangian(at.problem, moved(at.x, d, -t))) /
            (2.0 * t),
        slope, 1e-6 * std::abs(slope));
  }
}

TEST(Linearisation, StationarityIsTheLargestGradientOfThePrimalUnknowns) {
  const Disturbed at(6);
  const Linearisation lin(at.problem, at.x, {true, 0.0});
  Violation v = lin.violation();
  for (VectorXd& c : v.complementarity) c.setZero();
  const BlockVector r = lin.right_hand_side(v);
  double largest = r[0].lpNorm<Eigen::Infinity>();
  for (std::size_t k = 1; k < r.size(); ++k)
    largest = std::max(largest, r[k].head(9 + 3).lpNorm<Eigen::Infinity>());
  EXPECT_DOUBLE_EQ(lin.stationarity(), largest);
}

/// The Newton step.
BlockVector solution_of(const Linearisation& lin) {
  const auto solver = make_kkt_solver(KktMethod::kBlockElimination);
  EXPECT_TRUE(solver->factorize(lin.matrix()));
  return solver->solve(lin.right_hand_side(lin.violation()));
}

// To first order in α, x + α d leaves (1 - α) of every constraint.
TEST(Linearisation, StepSolvesTheLinearisedConstraints) {
  const Disturbed at(7);
  for (const Curvature curvature : {Curvature{false, 1.0}, Curvature{true, 0.1}}) {
    const Linearisation lin(at.problem, at.x, curvature);
    const Direction d = lin.direction(solution_of(lin), lin.violation());
    const double t = 1e-6;
    const Violation now = violation(at.problem, at.x);
    const Violation up = violation(at.problem, moved(at.x, d, t));
    const Violation down = violation(at.problem, moved(at.x, d, -t));
    for (std::size_t k = 0; k < now.residuals.size(); ++k) {
      const VectorXd slope = (up.residuals[k] - down.residuals[k]) / (2.0 * t);
      EXPECT_LT((slope + now.residuals[k]).lpNorm<Eigen::Infinity>(), 1e-6);
      const VectorXd other = (up.complementarity[k] - down.complementarity[k]) / (2.0 * t);
      EXPECT_LT((other + now.complementarity[k]).lpNorm<Eigen::Infinity>(), 1e-6);
    }
  }
}

TEST(Linearisation, ObjectiveSlopeMatchesDifferences) {
  const Disturbed at(8);
  const Linearisation lin(at.problem, at.x, {});
  const Direction d = lin.direction(solution_of(lin), lin.violation());
  const double t = 1e-6, slope = lin.objective_slope(d);
  EXPECT_NEAR(
      (objective(at.problem, moved(at.x, d, t)) - objective(at.problem, moved(at.x, d, -t))) /
          (2.0 * t),
      slope, 1e-6 * std::abs(slope));
}

/// |Δp|² + |Δc|² + 0.01 |Δλ|² of the step that s + t·u stands for.
double step_size(const Linearisation& lin, BlockVector s, const BlockVector& u, double t) {
  for (std::size_t k = 0; k < s.size(); ++k) s[k] += t * u[k];
  const Direction d = lin.direction(s, lin.violation());
  double sum = 0.0;
  for (std::size_t k = 0; k < d.p.size(); ++k)
    sum += d.p[k].squaredNorm() + d.controls[k].squaredNorm() + 0.01 * d.forces[k].squaredNorm();
  return sum;
}

// Newton's equations K s = r with it, less those without. The forces follow from the poses and from
// how far complementarity is from holding.
TEST(Linearisation, ProximalTermIsTheGradientOfTheSquaredStep) {
  const Disturbed at(10);
  const double proximal = 0.7;
  for (const bool exact : {false, true}) {
    const Linearisation with(at.problem, at.x, {exact, proximal});
    const Linearisation without(at.problem, at.x, {exact, 0.0});
    const auto left = [](const Linearisation& lin, const BlockVector& s) {
      return VectorXd(joined(product(lin.matrix(), s)) -
                      joined(lin.right_hand_side(lin.violation())));
    };
    const std::vector<BlockVector> all = directions(with, with.violation());
    const VectorXd term = left(with, all[0]) - left(without, all[0]);
    for (const BlockVector& u : all) {
      const double slope =
          0.25 * proximal * (step_size(with, all[0], u, 1.0) - step_size(with, all[0], u, -1.0));
      EXPECT_NEAR(term.dot(joined(u)), slope, 1e-9 * std::abs(slope));
    }
  }
}

// Controls enter the objective as ε |c|² alone, poses of the robot amid the way as κ |t|².
TEST(Linearisation, ModelCurvatureIsThatOfTheObjectiveAndTheProximalTerm) {
  const Disturbed at(9);
  const double proximal = 0.3;
  const Linearisation lin(at.problem, at.x, {false, proximal});
  BlockVector along = nothing(lin);
  along[3].segment<3>(9) = Vector3d(1.0, -2.0, 2.0);
  along[5].tail(9).setOnes();  // multipliers do not count
  EXPECT_NEAR(lin.model_curvature(along), 9.0 * (2.0 * at.config.control_weight + proximal), 1e-12);
}

}  // namespace
}  // namespace rtg

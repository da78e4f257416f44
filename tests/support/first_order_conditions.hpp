#pragma once

#include <gtest/gtest.h>

#include "tests/support/chain_scene.hpp"
#include "tests/support/linearisation.hpp"

namespace rtg::testing {

/// x moved by t along d; jointed bodies and their multipliers follow.
inline reverse::Iterate moved(const reverse::ReverseProblem& problem, reverse::Iterate x,
                              const Direction& d, double t) {
  for (std::size_t k = 0; k < x.p.size(); ++k) {
    const VectorXd y = to_coordinates(problem.energy, x.p[k], x.multipliers[k]);
    x.p[k] = advanced(problem.energy, x.p[k], t * d.p[k]);
    x.forces[k] += t * d.forces[k];
    x.controls[k] += t * d.controls[k];
    x.multipliers[k] = apply_jacobian(problem.energy, x.p[k], y + t * d.multipliers[k]);
  }
  return x;
}

/// The first-order conditions (∇L; Φ) with complementarity left out.
inline VectorXd conditions(const reverse::ReverseProblem& problem, const reverse::Iterate& x) {
  return joined(Linearisation(problem, x, {true, 0.0}).conditions());
}

/// A zero vector of the system.
inline BlockVector nothing(const Linearisation& lin) {
  BlockVector all;
  for (const MatrixXd& A : lin.matrix().A) all.push_back(VectorXd::Zero(A.rows()));
  return all;
}

inline BlockVector noise_like(const BlockTridiagonal& K, Rng& rng) {
  BlockVector x;
  for (const MatrixXd& A : K.A) x.push_back(noise(A.rows(), 1.0, rng));
  return x;
}

/// A vector of the system without the entries that belong to no coordinate.
inline BlockVector of_coordinates(const Linearisation& lin, const BlockVector& x) {
  StageStep<double> step = lin.step(x);
  const energy::StepEnergy& energy = lin.problem().energy;
  for (auto* levels : {&step.poses, &step.multipliers})
    for (std::size_t k = levels == &step.poses ? 0 : 1; k < levels->size(); ++k) {
      Eigen::Map<VectorXd> flat((*levels)[k][0].data(), energy.dofs());
      flat = of_coordinates(energy, flat);
    }
  return lin.assembled().written(step);
}

/// Five random directions and that of the gradient, along which errors do not average out.
inline std::vector<BlockVector> directions(const Linearisation& lin) {
  Rng rng(5);
  std::vector<BlockVector> all(5);
  for (BlockVector& along : all) along = of_coordinates(lin, noise_like(lin.matrix(), rng));
  all.push_back(lin.conditions());
  const double size = joined(all.back()).lpNorm<Eigen::Infinity>();
  for (VectorXd& block : all.back()) block /= size;
  return all;
}

/// Compares the system's matrix with central differences of the first-order conditions along
/// directions on which the forces follow the gaps (Δλ = b·Δp).
inline void expect_matrix_is_derivative(const reverse::ReverseProblem& problem,
                                        const reverse::Iterate& x) {
  const Linearisation lin(problem, x, {true, 0.0});
  for (const BlockVector& along : directions(lin)) {
    const Direction d = lin.direction(along, false);
    const double t = 1e-7;
    const VectorXd difference = (conditions(problem, moved(problem, x, d, t)) -
                                 conditions(problem, moved(problem, x, d, -t))) /
                                (2.0 * t);
    const VectorXd product = joined(rtg::product(lin.matrix(), along));
    EXPECT_LT((difference - product).lpNorm<Eigen::Infinity>(),
              1e-5 * product.lpNorm<Eigen::Infinity>());
  }
}

/// Expects that to first order in t, x + t d leaves (1 - t) of every constraint, d the Newton step
/// with either Hessian; by central differences over t.
inline void expect_step_solves_the_constraints(const reverse::ReverseProblem& problem,
                                               const reverse::Iterate& x, double t,
                                               double tolerance) {
  for (const Curvature curvature : {Curvature{false, 1.0}, Curvature{true, 0.1}}) {
    const Linearisation lin(problem, x, curvature);
    const Direction d = lin.direction(solution_of(lin), true);
    const reverse::Violation now = violation(problem, x);
    const reverse::Violation up = violation(problem, moved(problem, x, d, t));
    const reverse::Violation down = violation(problem, moved(problem, x, d, -t));
    for (std::size_t k = 0; k < now.residuals.size(); ++k) {
      const VectorXd slope = (up.residuals[k] - down.residuals[k]) / (2.0 * t);
      EXPECT_LT((slope + now.residuals[k]).lpNorm<Eigen::Infinity>(), tolerance);
      const VectorXd other = (up.complementarity[k] - down.complementarity[k]) / (2.0 * t);
      EXPECT_LT((other + now.complementarity[k]).lpNorm<Eigen::Infinity>(), tolerance);
    }
  }
}

/// J + Σ y·Φ.
inline double lagrangian(const reverse::ReverseProblem& problem, const reverse::Iterate& x) {
  const reverse::Violation v = violation(problem, x);
  double sum = objective(problem, x);
  for (std::size_t k = 1; k < x.p.size(); ++k)
    sum += to_coordinates(problem.energy, x.p[k], x.multipliers[k]).dot(v.residuals[k]);
  return sum;
}

/// Compares the right-hand side with differences of the Lagrangian, along directions that keep
/// complementarity (Δλ = b·Δp): its multipliers drop out there.
inline void expect_right_hand_side_is_gradient(const reverse::ReverseProblem& problem,
                                               const reverse::Iterate& x) {
  const Linearisation lin(problem, x, {true, 0.0});
  const VectorXd gradient = joined(lin.conditions());
  for (const BlockVector& along : directions(lin)) {
    const Direction d = lin.direction(along, false);
    const double t = 1e-7, slope = gradient.dot(joined(along));
    EXPECT_NEAR((lagrangian(problem, moved(problem, x, d, t)) -
                 lagrangian(problem, moved(problem, x, d, -t))) /
                    (2.0 * t),
                slope, 1e-6 * std::abs(slope));
  }
}

}  // namespace rtg::testing

#include "core/reverse/linearisation.hpp"

#include <algorithm>
#include <cmath>

#include "core/reverse/linearisation_builder.hpp"

namespace rtg {

Linearisation::Linearisation(const ReverseProblem& problem, const Iterate& x,
                             const Curvature& curvature)
    : problem_(&problem),
      h_(problem.sub_steps),
      n_(problem.energy.dofs()),
      violation_(rtg::violation(problem, x)) {
  LinearisationBuilder(*this, x, curvature).run();
}

double Linearisation::stationarity() const {
  double top = 0.0;
  for (int k = 0; k <= h_; ++k) {
    if (has_pose(k)) top = std::max(top, pose_gradient_[k].lpNorm<Eigen::Infinity>());
    top = std::max(top, control_gradient_[k].lpNorm<Eigen::Infinity>());
  }
  return top;
}

bool Linearisation::finite() const {
  double sum = violation_.l1();
  for (const VectorXd& gradient : pose_gradient_) sum += gradient.sum();
  for (const Vector3d& gradient : control_gradient_) sum += gradient.sum();
  return std::isfinite(sum);
}

BlockVector Linearisation::right_hand_side(const Violation& v) const {
  std::vector<VectorXd> gradient = pose_gradient_, residual = v.residuals;
  for (const Eliminated& e : eliminated_) {
    const Contact& c = problem_->energy.contacts()[e.contact];
    const double a = -v.complementarity[e.level][e.contact] / e.gap;
    if (e.level > 0) scatter(problem_->energy, c, Vec6<double>(a * e.normal), residual[e.level]);
    scatter(problem_->energy, c, Vec6<double>(a * e.now), gradient[e.level]);
    if (e.level == h_) continue;
    scatter(problem_->energy, c, Vec6<double>(a * e.friction), residual[e.level + 1]);
    scatter(problem_->energy, c, Vec6<double>(a * e.next), gradient[e.level + 1]);
  }
  BlockVector r;
  for (const MatrixXd& A : K_.A) r.push_back(VectorXd::Zero(A.rows()));
  for (int k = 0; k <= h_; ++k) {
    if (has_pose(k)) r[k].head(n_) = -gradient[k];
    if (k == 0) continue;
    r[control_place(k).block].segment<3>(control_place(k).row) = -control_gradient_[k];
    r[multiplier_place(k).block].segment(multiplier_place(k).row, n_) = -residual[k];
  }
  return r;
}

Direction Linearisation::direction(const BlockVector& solution, const Violation& v) const {
  const auto levels = static_cast<std::size_t>(h_) + 1;
  const auto contacts = static_cast<Eigen::Index>(problem_->energy.contacts().size());
  Direction d{std::vector<VectorXd>(levels, VectorXd::Zero(n_)),
              std::vector<VectorXd>(levels, VectorXd::Zero(contacts)),
              std::vector<Vector3d>(levels, Vector3d::Zero()),
              std::vector<VectorXd>(levels, VectorXd::Zero(n_))};
  for (int k = 0; k <= h_; ++k) {
    if (has_pose(k)) d.p[k] = solution[k].head(n_);
    if (k == 0) continue;
    d.controls[k] = solution[control_place(k).block].segment<3>(control_place(k).row);
    d.multipliers[k] = solution[multiplier_place(k).block].segment(multiplier_place(k).row, n_);
  }
  for (const Eliminated& e : eliminated_) {
    const Contact& c = problem_->energy.contacts()[e.contact];
    d.forces[e.level][e.contact] = -v.complementarity[e.level][e.contact] / e.gap +
                                   e.b.dot(gather(problem_->energy, c, d.p[e.level]));
  }
  return d;
}

double Linearisation::objective_slope(const Direction& d) const {
  double sum = 0.0;
  for (int k = 0; k <= h_; ++k)
    sum += objective_pose_[k].dot(d.p[k]) + objective_control_[k].dot(d.controls[k]);
  return sum;
}

double Linearisation::model_curvature(const BlockVector& solution) const {
  BlockVector primal = solution;
  for (int k = 1; k <= h_; ++k) primal[multiplier_place(k).block].tail(n_).setZero();
  return joined(primal).dot(joined(product(K_, primal)));
}

}  // namespace rtg

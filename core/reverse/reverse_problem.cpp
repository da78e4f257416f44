#include "core/reverse/reverse_problem.hpp"

#include <algorithm>
#include <cmath>

namespace rtg {
namespace {

/// Damping and actuation of Φ_k.
VectorXd free_residual(const ReverseProblem& problem, const Iterate& x, int k) {
  const StepEnergy& energy = problem.energy;
  VectorXd residual(energy.dofs());
  for (int i = 0; 3 * i < energy.dofs(); ++i) {
    const Vector3d moved = x.p[k].segment<3>(3 * i) - x.p[k - 1].segment<3>(3 * i);
    const Damping& body = energy.damping(i);
    residual.segment<3>(3 * i) << body.mass * moved.head<2>(), body.turn_slope(moved[2]);
  }
  const Vector3d push = x.controls[k].array().tanh();
  residual.head<3>() -= energy.control_bound().cwiseProduct(push);
  return residual;
}

}  // namespace

Vector3d ReverseProblem::robot_path(int k) const {
  const double back = energy.stride() * (sub_steps - k);
  Vector3d pose = end.head<3>();
  pose.head<2>() -= back * direction;
  return pose;
}

SpeedPenalty ReverseProblem::speed(const std::vector<VectorXd>& p, int k, int i) const {
  const auto level = static_cast<std::size_t>(k);
  return speed_penalty(config.speed_weight, energy.stride(), energy.damping(i),
                       (p[level] - p[level - 1]).segment<3>(3 * i));
}

Iterate static_iterate(const ReverseProblem& problem) {
  const auto levels = static_cast<std::size_t>(problem.sub_steps) + 1;
  return {std::vector<VectorXd>(levels, problem.end),
          std::vector<VectorXd>(levels, problem.energy.forces(problem.end)),
          std::vector<Vector3d>(levels, Vector3d::Zero()),
          std::vector<VectorXd>(levels, VectorXd::Zero(problem.energy.dofs()))};
}

bool may_act(const ReverseProblem& problem, const Iterate& x, int level, int contact) {
  return x.forces[level][contact] != 0.0 ||
         problem.energy.near(problem.energy.contacts()[contact], x.p[level]);
}

double objective(const ReverseProblem& problem, const Iterate& x) {
  const ReverseConfig& config = problem.config;
  const StepEnergy& energy = problem.energy;
  const int h = problem.sub_steps;
  double sum = 0.0;
  for (int i = 0; 3 * i < energy.dofs(); ++i) {
    const Vector2d moved = x.p[0].segment<2>(3 * i) - problem.end.segment<2>(3 * i);
    sum += (i == 0 ? config.robot_weight : config.object_weight) * problem.direction.dot(moved);
  }
  for (const Contact& c : energy.contacts())
    if (energy.near(c, x.p[0])) sum += energy.barrier().value(energy.gap_value(c, x.p[0]));
  for (int k = 0; k <= h; ++k) {
    if (k > 0) sum += config.control_weight * x.controls[k].squaredNorm();
    const Vector3d off = x.p[k].head<3>() - problem.robot_path(k);
    sum +=
        config.path_weight * off.head<2>().squaredNorm() + config.heading_weight * off[2] * off[2];
  }
  for (int k = 1; k <= h; ++k)
    for (int i = 1; 3 * i < energy.dofs(); ++i) sum += problem.speed(x.p, k, i).value;
  const VectorXd miss = (x.p[h] - problem.end).head(energy.dofs());
  return sum + 0.5 * config.terminal_weight * miss.squaredNorm();
}

double Violation::l1() const {
  double sum = 0.0;
  for (const VectorXd& r : residuals) sum += r.lpNorm<1>();
  for (const VectorXd& r : complementarity) sum += r.lpNorm<1>();
  return sum;
}

double Violation::max() const {
  double top = 0.0;
  for (const VectorXd& r : residuals) top = std::max(top, r.lpNorm<Eigen::Infinity>());
  for (const VectorXd& r : complementarity)
    if (r.size() > 0) top = std::max(top, r.lpNorm<Eigen::Infinity>());
  return top;
}

Violation violation(const ReverseProblem& problem, const Iterate& x) {
  const StepEnergy& energy = problem.energy;
  const int h = problem.sub_steps, contacts = static_cast<int>(energy.contacts().size());
  Violation v;
  v.residuals.assign(x.p.size(), VectorXd::Zero(energy.dofs()));
  v.complementarity.assign(x.p.size(), VectorXd::Zero(contacts));
  for (int k = 1; k <= h; ++k) v.residuals[k] = free_residual(problem, x, k);
  for (int k = 0; k <= h; ++k)
    for (int n = 0; n < contacts; ++n) {
      if (!may_act(problem, x, k, n)) continue;
      const Contact& c = energy.contacts()[n];
      const double force = x.forces[k][n];
      const LocalPoint<double> here = energy.point(c, x.p[k]);
      if (force == 0.0 && !energy.barrier().acts(energy.gap_value(c, here))) continue;
      const GapSlope<double> g = energy.gap_slope(c, here);
      v.complementarity[k][n] =
          force * g.value - energy.barrier().weight * energy.barrier().window(g.value).w;
      if (k > 0) scatter(energy, c, Vec6<double>(-force * g.gradient), v.residuals[k]);
      if (k == h || force == 0.0) continue;
      const LocalPoint<double> next = energy.point(c, x.p[k + 1]);
      scatter(energy, c, Vec6<double>(c.friction * force * energy.slip(c, next, here).gradient()),
              v.residuals[k + 1]);
    }
  return v;
}

double terminal_miss(const ReverseProblem& problem, const Iterate& x) {
  double most = 0.0;
  for (int i = 0; 3 * i < problem.energy.dofs(); ++i)
    most = std::max(most, (x.p.back() - problem.end).segment<2>(3 * i).norm());
  return most;
}

}  // namespace rtg

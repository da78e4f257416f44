#include "core/energy/implicit_step.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace rtg {
namespace {

constexpr int kMaxIterations = 100;
constexpr double kTolerance = 1e-10;  // [kg m]
constexpr double kArmijo = 1e-4;
constexpr double kLeastStep = 1e-12;
constexpr double kKeptGap = 0.1;  // share of a gap that an iteration leaves

double log_cosh(double x) {
  const double a = std::abs(x);
  return a + std::log1p(std::exp(-2.0 * a)) - std::log(2.0);
}

/// The drive's potential over p₊₀, its gradient and (diagonal) Hessian.
class DriveEnergy {
 public:
  DriveEnergy(const StepEnergy& energy, const Drive& drive)
      : drive_(drive), bound_(energy.control_bound()), scale_(servo_scale(energy)) {}

  /// c at a robot pose.
  Vector3d control(const Vector3d& robot) const {
    return drive_.servo ? Vector3d((drive_.target - robot).cwiseQuotient(scale_)) : drive_.control;
  }

  double value(const Vector3d& robot) const {
    const Vector3d c = control(robot);
    double sum = 0.0;
    for (int m = 0; m < 3; ++m)
      sum += drive_.servo ? bound_[m] * scale_[m] * log_cosh(c[m])
                          : -bound_[m] * std::tanh(c[m]) * robot[m];
    return sum;
  }

  void add_to(const Vector3d& robot, StepEnergy::Model& model) const {
    const Vector3d push = control(robot).array().tanh();
    model.gradient.head<3>() -= bound_.cwiseProduct(push);
    if (!drive_.servo) return;
    const Vector3d bend = bound_.array() * (1.0 - push.array().square()) / scale_.array();
    model.hessian.diagonal().head<3>() += bend;
  }

 private:
  Drive drive_;
  Vector3d bound_, scale_;
};

/// Newton direction of the Hessian made positive definite by a growing multiple of its diagonal.
VectorXd descent_direction(const StepEnergy::Model& model) {
  const double size = model.hessian.diagonal().cwiseAbs().maxCoeff();
  Eigen::LLT<MatrixXd> factor(model.hessian);
  for (double shift = 1e-6 * size; factor.info() != Eigen::Success; shift *= 10.0) {
    MatrixXd shifted = model.hessian;
    shifted.diagonal().array() += shift;
    factor.compute(shifted);
  }
  return -factor.solve(model.gradient);
}

}  // namespace

Vector3d servo_scale(const StepEnergy& energy) {
  const double s = kServoShare * energy.stride();
  return {s, s, s};
}

std::optional<ImplicitStep> implicit_step(const StepEnergy& energy, const VectorXd& now,
                                          const VectorXd& lag, const Drive& drive) {
  const DriveEnergy servo(energy, drive);
  VectorXd p = now;
  double value = energy.value(p, now, lag) + servo.value(p.head<3>());
  for (int i = 0; i < kMaxIterations && std::isfinite(value); ++i) {
    StepEnergy::Model model = energy.model(p, now, lag);
    servo.add_to(p.head<3>(), model);
    if (!model.gradient.allFinite() || !model.hessian.allFinite()) return std::nullopt;
    if (model.gradient.lpNorm<Eigen::Infinity>() < kTolerance)
      return ImplicitStep{p, servo.control(p.head<3>()), i};
    const VectorXd direction = descent_direction(model);
    const double slope = model.gradient.dot(direction);
    const double noise = 1e-15 * (1.0 + std::abs(value));
    double step = 1.0;
    for (;; step *= 0.5) {
      if (step < kLeastStep) return std::nullopt;
      VectorXd trial = p;
      trial.head(energy.dofs()) += step * direction;
      if (!energy.keeps_gaps(p, trial, kKeptGap)) continue;
      const double after = energy.value(trial, now, lag) + servo.value(trial.head<3>());
      if (!(after <= value + kArmijo * step * slope + noise)) continue;
      p = trial;
      value = after;
      break;
    }
  }
  return std::nullopt;
}

}  // namespace rtg

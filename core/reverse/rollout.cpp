#include "core/reverse/rollout.hpp"

#include <algorithm>
#include <cmath>

#include "core/energy/implicit_step.hpp"
#include "core/energy/open_gaps.hpp"

namespace rtg {
namespace {

constexpr int kCorrections = 6;
constexpr double kGoodEnough = 1e-3;  // miss of a reverse step that needs no correction [m]
constexpr double kLeastCorrection = 0.05;

std::optional<VectorXd> forward(const ReverseProblem& problem, const VectorXd& p,
                                const Vector3d& target) {
  auto step = implicit_step(problem.energy, p, problem.energy.forces(p), Drive::towards(target));
  if (!step) return std::nullopt;
  return std::move(step->next);
}

/// The straight path's pose after sub-step k, led by what the servo lags behind in free motion.
Vector3d straight_target(const ReverseProblem& problem, int k) {
  const StepEnergy& energy = problem.energy;
  const double share = energy.damping(0).mass * energy.stride() / energy.control_bound()[0];
  Vector3d lead = Vector3d::Zero();
  if (share < 1.0) lead.head<2>() = std::atanh(share) * problem.direction;
  return problem.robot_path(k) + servo_scale(energy).cwiseProduct(lead);
}

/// `p` with its objects moved by -share·by for the largest share in 1, ½, ... that leaves the gaps
/// open; nothing below the least share. The robot's part of `by` is ignored.
std::optional<VectorXd> moved_back(const StepEnergy& energy, const VectorXd& p,
                                   const VectorXd& by) {
  const double floor = std::min(kGapFloor * energy.barrier().range, least_gap(energy, p));
  for (double share = 1.0; share > kLeastCorrection; share *= 0.5) {
    VectorXd trial = p;
    trial.tail(p.size() - 3) -= share * by.tail(p.size() - 3);
    if (least_gap(energy, trial) >= floor && energy.separated(trial)) return trial;
  }
  return std::nullopt;
}

/// A state that sub-step k leads close to `end`, the robot on its straight path.
std::optional<VectorXd> reverse_step(const ReverseProblem& problem, const VectorXd& end, int k) {
  const StepEnergy& energy = problem.energy;
  const Vector3d target = straight_target(problem, k);
  Vector3d advanced = end.head<3>();
  advanced.head<2>() += energy.stride() * problem.direction;
  const auto pushed = forward(problem, end, advanced);
  const auto still = forward(problem, end, end.head<3>());
  if (!pushed || !still) return std::nullopt;
  VectorXd back = end;
  back.head<3>() = problem.robot_path(k - 1);
  std::optional<VectorXd> best = moved_back(energy, back, *pushed - *still);
  if (!best) best = back;
  double best_miss = INFINITY;
  VectorXd p = *best;
  for (int i = 0; i < kCorrections && best_miss > kGoodEnough; ++i) {
    const auto reached = forward(problem, p, target);
    if (!reached) break;
    const VectorXd miss = *reached - end;
    if (miss.tail(miss.size() - 3).norm() < best_miss) {
      best_miss = miss.tail(miss.size() - 3).norm();
      best = p;
    }
    const auto next = moved_back(energy, p, miss);
    if (!next) break;
    p = *next;
  }
  return best;
}

}  // namespace

ServoTargets straight_targets(const ReverseProblem& problem) {
  ServoTargets targets;
  for (int k = 0; k <= problem.sub_steps; ++k) targets.push_back(straight_target(problem, k));
  return targets;
}

std::optional<Iterate> roll_out(const ReverseProblem& problem, const VectorXd& start,
                                const ServoTargets& targets) {
  const StepEnergy& energy = problem.energy;
  Iterate x = static_iterate(problem);
  x.p[0] = start;
  x.forces[0] = energy.forces(start);
  for (std::size_t k = 1; k < x.p.size(); ++k) {
    const auto step =
        implicit_step(energy, x.p[k - 1], x.forces[k - 1], Drive::towards(targets[k]));
    if (!step) return std::nullopt;
    x.p[k] = step->next;
    x.controls[k] = step->control;
    x.forces[k] = energy.forces(x.p[k]);
  }
  return x;
}

std::optional<Iterate> warm_start(const ReverseProblem& problem) {
  const ServoTargets targets = straight_targets(problem);
  VectorXd p = problem.end;
  for (int k = problem.sub_steps; k > 0; --k) {
    const auto before = reverse_step(problem, p, k);
    if (!before) return std::nullopt;
    p = *before;
  }
  return roll_out(problem, p, targets);
}

}  // namespace rtg

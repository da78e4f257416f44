#include "core/reverse/trial.hpp"

#include <cmath>

namespace rtg {
namespace {

constexpr double kKeptGap = 0.1;
constexpr double kLongestMove = 1.0;  // [m]
constexpr double kLargestTurn = 0.5;  // [rad]
constexpr double kNoForce = 1e-14;    // [kg m], the rest of a contact that has opened

bool bounded(const VectorXd& step) {
  for (Eigen::Index i = 0; i < step.size(); i += 3)
    if (!(step.segment<2>(i).norm() <= kLongestMove && std::abs(step[i + 2]) <= kLargestTurn))
      return false;
  return true;
}

}  // namespace

std::optional<Iterate> trial_point(const ReverseProblem& problem, const Iterate& x,
                                   const Direction& d, double alpha) {
  const StepEnergy& energy = problem.energy;
  Iterate trial = x;
  for (std::size_t k = 0; k < x.p.size(); ++k) {
    const VectorXd step = alpha * d.p[k];
    if (!bounded(step)) return std::nullopt;
    trial.p[k].head(energy.dofs()) += step;
    trial.controls[k] += alpha * d.controls[k];
    trial.multipliers[k] += alpha * d.multipliers[k];
    if (!energy.keeps_gaps(x.p[k], trial.p[k], kKeptGap)) return std::nullopt;
    if (problem.slaved_forces()) {
      trial.forces[k] = energy.forces(trial.p[k]);
    } else {
      trial.forces[k] += alpha * d.forces[k];
      trial.forces[k] =
          trial.forces[k].unaryExpr([](double f) { return std::abs(f) < kNoForce ? 0.0 : f; });
    }
  }
  return trial;
}

}  // namespace rtg

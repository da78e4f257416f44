#include "core/reverse/pace.hpp"

#include <algorithm>

#include "core/math/elementary.hpp"

namespace rtg::reverse {
namespace {

constexpr double kUsed = 0.99;   // share of B_f of the slowest push; tanh c does not reach 1
constexpr double kLeast = 1e-3;  // share of B_f below which the robot catches up at once

}  // namespace

double least_pace(const ReverseProblem& problem, const Scene& scene) {
  const energy::StepEnergy& energy = problem.energy;
  if (problem.config.path_weight == 0.0) return 1.0;
  double heaviest = 0.0;
  for (std::size_t i = 1; i < scene.size(); ++i)
    if (!scene.bodies[i].fixed && !has_joint(scene, i))
      heaviest = std::max(heaviest, energy.damping(static_cast<int>(i)).mass);
  const double drag = energy.stride() * (energy.damping(0).mass + heaviest);
  return std::min(1.0, kUsed * energy.control_bound()[0] / drag);
}

double sustained_pace(const ReverseProblem& problem, const Iterate& x) {
  const int pushing = problem.sub_steps - problem.settling;
  double lag = 0.0;
  for (int k = 1; k <= pushing; ++k) {
    const Vector3d& c = x.controls[static_cast<std::size_t>(k)];
    const double share = hyperbolic_tangent(c[0]) * problem.direction.x() +
                         hyperbolic_tangent(c[1]) * problem.direction.y();
    lag = std::max(0.0, lag + 1.0 - problem.pace / std::max(share, kLeast));
  }
  return 1.0 - lag / pushing;
}

}  // namespace rtg::reverse

#include "core/reverse/pace.hpp"

#include <algorithm>

#include "core/math/elementary.hpp"

namespace rtg::reverse {
namespace {

constexpr double kLeast = 1e-3;  // share of B_f below which the robot catches up at once

}  // namespace

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

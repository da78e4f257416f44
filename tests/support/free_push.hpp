#pragma once

#include <gtest/gtest.h>

#include "core/reverse/problem/reverse_problem.hpp"

namespace rtg::testing {

/// `config` with the paper's objective and the final state fixed: reverse problems that have a
/// closed form where nothing touches.
inline reverse::ReverseConfig free_push_config(reverse::ReverseConfig config) {
  config.path_weight = config.heading_weight = config.terminal_weight = 0.0;
  return config;
}

/// With Φ_k solved for the poses, t₀ = t_h - B/m Σ tanh c_k, the objective falls apart into one
/// function of each control, -w₀ d B/m tanh c + ε c², whose derivative is monotone for d c ≥ 0.
/// Returns its zero, by bisection.
inline double closed_form_control(const reverse::ReverseProblem& problem, double d) {
  const double pull = problem.config.robot_weight * std::abs(d) *
                      problem.energy.control_bound()[0] / problem.energy.damping(0).mass;
  double low = 0.0, high = 50.0;
  for (int k = 0; k < 200; ++k) {
    const double middle = 0.5 * (low + high), cosh = std::cosh(middle);
    const bool rising = 2.0 * problem.config.control_weight * middle > pull / (cosh * cosh);
    (rising ? high : low) = middle;
  }
  return std::copysign(low, d);
}

inline void expect_closed_form(const reverse::ReverseProblem& problem, const reverse::Iterate& x,
                               double tolerance) {
  const double reach = problem.energy.control_bound()[0] / problem.energy.damping(0).mass;
  for (int m = 0; m < 2; ++m) {
    const double c = closed_form_control(problem, problem.direction[m]);
    for (int k = 0; k <= problem.sub_steps; ++k) {
      const auto level = static_cast<std::size_t>(k);
      if (k > 0) {
        EXPECT_NEAR(x.controls[level][m], c, tolerance);
      }
      EXPECT_NEAR(x.p[level][m], problem.end[m] - (problem.sub_steps - k) * reach * std::tanh(c),
                  tolerance);
    }
  }
  for (const VectorXd& p : x.p) EXPECT_NEAR(p[2], problem.end[2], 1e-9);
}

}  // namespace rtg::testing

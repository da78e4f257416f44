#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <functional>
#include <vector>

#include "core/math/block_tridiagonal.hpp"
#include "core/math/rng.hpp"

namespace rtg::testing {

using VectorFunction = std::function<VectorXd(const VectorXd&)>;

/// (f(x + t d) - f(x - t d)) / 2t.
inline VectorXd central_difference(const VectorFunction& f, const VectorXd& x, const VectorXd& d,
                                   double t = 1e-6) {
  return (f(x + t * d) - f(x - t * d)) / (2.0 * t);
}

/// Unit directions to test derivatives along: 6 random ones and that of `gradient`, along which
/// errors do not average out.
inline std::vector<VectorXd> test_directions(const VectorXd& gradient, Rng& rng) {
  std::vector<VectorXd> directions;
  for (int k = 0; k < 6; ++k)
    directions.push_back(VectorXd::NullaryExpr(gradient.size(), [&] {
                           return rng.uniform(-1.0, 1.0);
                         }).normalized());
  if (gradient.norm() > 0.0) directions.push_back(gradient.normalized());
  return directions;
}

/// Largest ‖J d - difference of f along d‖∞ over the directions d, in units of 1 + ‖J d‖∞.
inline double derivative_error(const VectorFunction& f, const MatrixXd& J, const VectorXd& x,
                               const std::vector<VectorXd>& directions) {
  double worst = 0.0;
  for (const VectorXd& d : directions) {
    const VectorXd product = J * d;
    const VectorXd error = product - central_difference(f, x, d);
    worst = std::max(worst,
                     error.lpNorm<Eigen::Infinity>() / (1.0 + product.lpNorm<Eigen::Infinity>()));
  }
  return worst;
}

}  // namespace rtg::testing

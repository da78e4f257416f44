#pragma once

#include <algorithm>

namespace rtg::reverse {

/// The l1 merit function M = J + ν ‖C‖₁ of A.2, above eq. (9). It is exact once ν exceeds every
/// multiplier.
class Merit {
 public:
  /// Raises ν, if necessary, above `multiplier` = ‖y‖∞ by a margin.
  void raise_weight_above(double multiplier) {
    weight_ = std::max(weight_, kMargin * multiplier + kLeast);
  }
  double weight() const { return weight_; }
  double value(double objective, double violation) const { return objective + weight_ * violation; }
  /// Returns the derivative of M along a Newton step. The derivative of ‖C‖₁ is -‖C‖₁ there.
  double slope(double objective_slope, double violation) const {
    return objective_slope - weight_ * violation;
  }

 private:
  static constexpr double kMargin = 1.5, kLeast = 1e-3;
  double weight_ = kLeast;
};

}  // namespace rtg::reverse

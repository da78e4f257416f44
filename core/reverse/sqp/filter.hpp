#pragma once

#include <vector>

namespace rtg::reverse {

/// Filter of [Fletcher & Leyffer 2002]: a set of pairs (θ, J) of constraint violation and
/// objective. It accepts a trial point that is better than each pair in θ or in J.
class Filter {
 public:
  struct Entry {
    double violation = 0.0;  // θ = ‖C‖₁
    double objective = 0.0;  // J
  };

  /// Returns whether `trial` is better than each entry, in violation or in objective, by the
  /// margin.
  bool accepts(const Entry& trial) const {
    for (const Entry& e : entries_)
      if (trial.violation >= (1.0 - kMargin) * e.violation &&
          trial.objective >= e.objective - kMargin * e.violation)
        return false;
    return true;
  }

  /// Returns whether `trial` is better than `now` in violation or objective, by the margin.
  static bool improves(const Entry& trial, const Entry& now) {
    return trial.violation <= (1.0 - kMargin) * now.violation ||
           trial.objective <= now.objective - kMargin * now.violation;
  }

  void add(const Entry& e) { entries_.push_back(e); }

 private:
  static constexpr double kMargin = 1e-5;
  std::vector<Entry> entries_;
};

}  // namespace rtg::reverse

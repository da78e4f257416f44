#pragma once

#include <vector>

namespace rtg::reverse {

/// Filter of [Fletcher & Leyffer 2002]: remembers pairs (θ, J) of constraint violation and
/// objective; a trial point must be better than each in one of the two.
class Filter {
 public:
  struct Entry {
    double violation = 0.0;  // θ = ‖C‖₁
    double objective = 0.0;  // J
  };

  /// Says whether no entry is as good as `trial` in both.
  bool accepts(const Entry& trial) const {
    for (const Entry& e : entries_)
      if (trial.violation >= (1.0 - kMargin) * e.violation &&
          trial.objective >= e.objective - kMargin * e.violation)
        return false;
    return true;
  }

  /// Says whether `trial` improves on `now` in one of the two by the margin.
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

#pragma once

#include "core/math/stage_system.hpp"

namespace rtg::testing {

/// Returns lane l of a step.
template <class T>
StageStep<double> lane_of(const StageStep<T>& step, int l) {
  StageStep<double> one(static_cast<int>(step.poses[0].size()),
                        static_cast<int>(step.poses.size()) - 1);
  const auto copy = [l](const Vec3<T>& from, Vec3<double>& to) {
    for (int m = 0; m < 3; ++m) to[m] = lane(from[m], l);
  };
  for (std::size_t k = 0; k < step.poses.size(); ++k) {
    for (std::size_t i = 0; i < step.poses[k].size(); ++i) copy(step.poses[k][i], one.poses[k][i]);
    if (k == 0) continue;
    copy(step.controls[k], one.controls[k]);
    for (std::size_t i = 0; i < step.poses[k].size(); ++i)
      copy(step.multipliers[k][i], one.multipliers[k][i]);
  }
  return one;
}

}  // namespace rtg::testing

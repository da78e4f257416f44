#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "nodes/bus/seconds.hpp"

namespace rtg::jobs {

/// The latest durations of an event that happens over and over.
class RecentTimes {
 public:
  void add(bus::Seconds time) {
    if (times_.size() < kKept)
      times_.push_back(time);
    else
      times_[next_++ % kKept] = time;
  }

  /// Returns the median of the times, or nothing while there are too few to tell.
  std::optional<bus::Seconds> median() const {
    if (times_.size() < kLeast) return std::nullopt;
    std::vector<bus::Seconds> sorted = times_;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::ranges::nth_element(sorted, middle);
    return *middle;
  }

 private:
  static constexpr std::size_t kKept = 64, kLeast = 16;

  std::vector<bus::Seconds> times_;
  std::size_t next_ = 0;
};

}  // namespace rtg::jobs

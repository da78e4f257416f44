#pragma once

#include "nodes/bus/seconds.hpp"

namespace rtg::jobs {

/// Tells how many copies of a message to send. A lost message stalls a batch until it is missed, so
/// once one had to be repeated, those of the next seconds go out several times. Receivers drop
/// copies by the id of the unit.
class Copies {
 public:
  /// Takes note that a message was repeated.
  void on_repeat(bus::Seconds now) { until_ = now + kAlert; }

  int count(bus::Seconds now) const { return now < until_ ? kCopies : 1; }

 private:
  static constexpr bus::Seconds kAlert = 5.0;
  static constexpr int kCopies = 3;

  bus::Seconds until_ = -1.0;
};

}  // namespace rtg::jobs

#pragma once

#include <map>
#include <string>
#include <utility>

#include "nodes/bus/bus.hpp"
#include "nodes/bus/clock.hpp"

namespace rtg::bus {

/// Tells people what a process does and what it has counted: RTG_STATUS.
class NodeStatus {
 public:
  NodeStatus(Bus& bus, std::string node, int number)
      : bus_(bus), node_(std::move(node)), number_(number) {}

  /// Says whether it is time to publish(): twice a second.
  bool due(Seconds now) { return ticker_.due(now); }

  /// `done` as in node_status_t. `counts` are told beside the bus's counters.
  void publish(const std::string& state, std::int64_t done,
               const std::map<std::string, long>& counts = {});

 private:
  Bus& bus_;
  std::string node_;
  int number_;
  Ticker ticker_{0.5};
};

/// Says whether the coordinator is still there, as worker and server hear it: RTG_PROGRESS.
class CoordinatorWatch {
 public:
  static constexpr Seconds kSilence = 30.0;

  explicit CoordinatorWatch(Bus& bus);

  /// It has said that it ends.
  bool leaving() const { return leaving_; }
  /// It has not been heard for kSilence.
  bool silent(Seconds now) const { return now - heard_ > kSilence; }

 private:
  bool leaving_ = false;
  Seconds heard_ = monotonic_now();
};

}  // namespace rtg::bus

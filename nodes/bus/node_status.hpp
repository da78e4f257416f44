#pragma once

#include <map>
#include <string>
#include <utility>

#include "nodes/bus/bus.hpp"
#include "nodes/bus/clock.hpp"

namespace rtg::bus {

/// Publishes the state and counters of a process on channel RTG_STATUS, for people to read.
class NodeStatus {
 public:
  NodeStatus(Bus& bus, std::string node, int number)
      : bus_(bus), node_(std::move(node)), number_(number) {}

  /// Returns whether it is time to call publish(), twice a second.
  bool due(Seconds now) { return ticker_.due(now); }

  /// Publishes `state`, the work done so far (`done`, see node_status_t), `counts` and the counters
  /// of the bus.
  void publish(const std::string& state, std::int64_t done,
               const std::map<std::string, long>& counts = {});

 private:
  Bus& bus_;
  std::string node_;
  int number_;
  Ticker ticker_{0.5};
};

/// Watches the coordinator by its messages on channel RTG_PROGRESS. Workers and the simulation
/// server use it to know when to end.
class CoordinatorWatch {
 public:
  static constexpr Seconds kSilence = 120.0;  // longer than a machine freezes

  explicit CoordinatorWatch(Bus& bus);

  /// Returns whether the coordinator has announced that it is leaving, and nothing else since.
  bool leaving() const { return leaving_; }
  /// Returns whether no message of the coordinator has arrived for kSilence.
  bool silent(Seconds now) const { return now - heard_ > kSilence; }

 private:
  bool leaving_ = false;
  Seconds heard_ = monotonic_now();
};

}  // namespace rtg::bus

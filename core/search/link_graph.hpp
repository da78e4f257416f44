#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "core/search/state_metric.hpp"
#include "core/search/transition.hpp"

namespace rtg {

/// Transitions as links of a graph: b follows a if b begins where a ends, each body within kLink of
/// its place along either axis and, the robot aside, of its angle, modulo symmetry.
class LinkGraph {
 public:
  static constexpr double kLink = 0.25;  // [m], [rad]; the default gap tolerance

  explicit LinkGraph(const Scene& scene) : metric_(scene) {}

  void add(const Transition& transition);

  long size() const { return static_cast<long>(links_.size()); }

  /// Share of the links from which one with success can be reached.
  double reachable_share() const;

 private:
  struct Link {
    Poses from, to;
    bool success;
  };
  /// Links by the square of side kLink that their robot ends in.
  using Squares = std::unordered_map<std::uint64_t, std::vector<std::size_t>>;

  void take_before(const Link& link, Squares& ends, std::vector<std::size_t>& open) const;

  StateMetric metric_;
  std::vector<Link> links_;
};

}  // namespace rtg

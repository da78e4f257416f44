#pragma once

#include <vector>

#include "core/search/link_graph.hpp"
#include "core/search/state_metric.hpp"
#include "core/search/transition.hpp"
#include "core/tasks/task.hpp"

namespace rtg {

/// Half width of the start region: every object's x and y within this of its nominal start [m], the
/// domain randomisation of the paper's Gathering (App. D), and its angle within kStartAngle modulo
/// the symmetry of its shape [rad]. The robot may be anywhere: it gets about freely.
inline constexpr double kStartRegion = 0.5;
inline constexpr double kStartAngle = 0.35;

/// Whether a state lies in the start region of the task.
bool in_start_region(const Task& task, const StateMetric& metric, const Poses& poses);

/// Counts what a stream of transitions covers.
class Coverage {
 public:
  explicit Coverage(const Task& task);

  void add(const Transition& transition);

  long transitions() const { return links_.size(); }
  double contact_share() const;     // moved an object by more than kMoved
  double multi_body_share() const;  // moved two or more that no joint connects
  long start_region() const { return start_region_; }
  long start_region_trees() const { return start_region_trees_; }  // those found backwards

  /// Share of the transitions from which a success is reachable, see LinkGraph.
  double reachable_share() const { return links_.reachable_share(); }

 private:
  bool moves_several(const Transition& t) const;

  const Task& task_;
  StateMetric metric_;
  std::vector<std::size_t> movers_;  // as movers_of()
  LinkGraph links_;
  long contacts_ = 0, multi_body_ = 0, start_region_ = 0, start_region_trees_ = 0;
};

}  // namespace rtg

#pragma once

#include <cstdint>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "core/search/generation.hpp"
#include "core/search/seams.hpp"
#include "core/search/state_metric.hpp"

namespace rtg::search {

/// A beam search forwards from one start, in the simulator, without reverse steps. It tries every
/// heading in every state of the beam. States are ranked by goal_distance(). The beam, of at
/// most config.forward_breadth nodes, is selected by select_beam(), as in BeamSearch.
class ForwardSearch {
 public:
  /// `task` and `config` must outlive the search.
  ForwardSearch(const tasks::Task& task, const SearchConfig& config, Poses start);

  /// Simulates every heading in every state of the beam and makes the best new states the next
  /// beam. Returns the steps to these states. Returns none after the first success, or if all new
  /// states are known.
  std::vector<Transition> grow(const ReplayBatch& replay);

  /// Returns the outcome of a push that the latest grow() simulated. Throws std::out_of_range for
  /// any other push.
  const ReplayResult& outcome(const ReplayJob& push) const;

  /// Returns the steps from the start to the first success found; none if there is no success.
  std::vector<Transition> plan() const;

 private:
  struct Node {
    Transition step;
    std::size_t parent;  // index of the node in whose state the step begins
  };

  const tasks::Task& task_;
  const SearchConfig& config_;
  StateMetric metric_;
  std::vector<Node> nodes_;
  std::vector<std::size_t> beam_;
  std::size_t solved_ = 0;  // first node whose step succeeds; 0: none
  std::unordered_set<std::uint64_t> seen_;
  std::unordered_map<std::uint64_t, ReplayResult> outcomes_;  // by key_of() of state and action
};

/// Searches from `start` and returns the plan; empty if none is found. A plan has at most
/// min(config.depth, task.horizon) actions. A pure function of the arguments.
std::vector<Transition> plan_forward(const tasks::Task& task, const SearchConfig& config,
                                     const Poses& start, const ReplayBatch& replay);

/// Runs forward search number `number` from a random start, run.draw_start(). Stores the steps to
/// the states of each beam. Their branches cost nothing: the search has simulated all headings.
void search_forward(Generation& run, int number);

}  // namespace rtg::search

#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "core/search/beam_selection.hpp"
#include "core/search/generation.hpp"
#include "core/search/seams.hpp"
#include "core/search/state_metric.hpp"

namespace rtg::search {

/// Plans without reverse steps: a forward beam search from one start, over all headings, in the
/// simulator. States are ranked by goal_distance(); the beam is selected as in BeamSearch.
class ForwardSearch {
 public:
  /// `task` and `config` must outlive the search.
  ForwardSearch(const tasks::Task& task, const SearchConfig& config, Poses start);

  /// Grows a layer: replays every heading in every state of the beam and keeps the best steps.
  /// Returns the steps that were kept; none if the search has ended.
  std::vector<Transition> grow(const ReplayBatch& replay);

  /// Returns the outcome of a push that the last layer replayed. Throws std::out_of_range for any
  /// other push.
  const ReplayResult& outcome(const ReplayJob& push) const;

  /// Returns the steps from the start to the first success found; none if there is no success.
  std::vector<Transition> plan() const;

 private:
  struct Node {
    Transition step;
    std::size_t parent;  // the node in whose state the step begins; the first has none
  };
  std::vector<Transition> keep(std::vector<Node> found, std::span<const BeamEntry> entries);

  const tasks::Task& task_;
  const SearchConfig& config_;
  StateMetric metric_;
  std::vector<Node> nodes_;
  std::vector<std::size_t> beam_;
  std::size_t solved_ = 0;  // first node whose step succeeds; 0: none
  std::unordered_set<std::uint64_t> seen_;
  std::unordered_map<std::uint64_t, ReplayResult> outcomes_;  // by key_of() of state and action
};

/// Runs a whole search, of at most config.depth and task.horizon actions, and returns its plan. A
/// pure function of the arguments.
std::vector<Transition> plan_forward(const tasks::Task& task, const SearchConfig& config,
                                     const Poses& start, const ReplayBatch& replay);

/// Runs search number `number` from a start (run.draw_start()) and stores the steps that it keeps.
/// Their branches are outcomes that the search has simulated anyway.
void search_forward(Generation& run, int number);

}  // namespace rtg::search

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

/// Planning without reverse steps: a beam search forwards from one start, over all headings, in the
/// simulator, ranked by goal_distance(); selection of the beam as in BeamSearch.
class ForwardSearch {
 public:
  /// `task` and `config` must outlive the search.
  ForwardSearch(const tasks::Task& task, const SearchConfig& config, Poses start);

  /// Goes an action on: replays every heading of every state of the beam and keeps the best. The
  /// steps that were kept come back; none if the search has come to its end.
  std::vector<Transition> grow(const ReplayBatch& replay);

  /// Answers a push that the last layer replayed.
  const ReplayResult& outcome(const ReplayJob& push) const;

  /// The steps from the start to the first success found; none without one.
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
  std::size_t solved_ = 0;  // the node whose step succeeds; 0: there is none
  std::unordered_set<std::uint64_t> seen_;
  std::unordered_map<std::uint64_t, ReplayResult> outcomes_;  // by key_of() of state and action
};

/// A whole search of config.depth actions at most: its plan. A function of the arguments.
std::vector<Transition> plan_forward(const tasks::Task& task, const SearchConfig& config,
                                     const Poses& start, const ReplayBatch& replay);

/// Stores what one search keeps, from a start (run.draw_start()), with branches that it has
/// simulated anyway. Number `number` of the searches.
void search_forward(Generation& run, int number);

}  // namespace rtg::search

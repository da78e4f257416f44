#pragma once

#include <cstdint>
#include <unordered_set>
#include <vector>

#include "core/math/rng.hpp"
#include "core/search/batches.hpp"
#include "core/search/generation.hpp"
#include "core/search/state_metric.hpp"

namespace rtg {

/// Planning without reverse steps: a beam search forwards from one start, over all headings, in the
/// simulator, ranked by goal_distance(); selection of the beam as in BeamSearch.
class ForwardSearch {
 public:
  /// `task` and `config` must outlive the search.
  ForwardSearch(const Task& task, const SearchConfig& config, Poses start, std::uint64_t seed);

  /// One action more: replays every heading of every state of the beam, keeps the best. The steps
  /// that were kept; none if the search has come to its end.
  std::vector<Transition> grow(const ReplayBatch& replay);

  /// The steps from the start to the first success found; none without one.
  std::vector<Transition> plan() const;

 private:
  struct Node {
    Transition step;
    std::size_t parent;  // the node in whose state the step begins; the first has none
  };

  const Task& task_;
  const SearchConfig& config_;
  StateMetric metric_;
  Rng rng_;
  std::vector<Node> nodes_;
  std::vector<std::size_t> beam_;
  std::size_t solved_ = 0;  // the node whose step succeeds; 0: there is none
  std::unordered_set<std::uint64_t> seen_;
};

/// A whole search of config.depth actions at most: its plan. A function of the arguments.
std::vector<Transition> plan_forward(const Task& task, const SearchConfig& config,
                                     const Poses& start, std::uint64_t seed,
                                     const ReplayBatch& replay);

/// Stores what one search keeps, from a start with objects moved by up to ±
/// config.target_jitter [m]. Number `number` of the searches.
void search_forward(Generation& run, int number);

}  // namespace rtg

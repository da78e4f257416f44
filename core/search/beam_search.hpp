#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <unordered_set>
#include <vector>

#include "core/math/rng.hpp"
#include "core/search/predecessor.hpp"
#include "core/search/search_config.hpp"
#include "core/search/search_stats.hpp"
#include "core/search/state_metric.hpp"

namespace rtg::search {

/// A state from which `action` and then the actions of the node `parent` lead to success.
struct Node {
  Poses poses;
  int action = -1;  // -1: the goal holds
  int parent = -1;  // index of a node
  int depth = 0;    // actions until success
};

/// A tree of reverse steps, grown layer by layer from goal states towards a layout (Algorithm 1).
class BeamSearch {
 public:
  /// `task` and `config` must outlive the search; `target`: the layout.
  BeamSearch(const tasks::Task& task, const SearchConfig& config, Poses target, std::uint64_t seed);

  /// Makes goal states near the target (goal_roots()), brought to rest by `replay`, the first beam.
  void plant(const ReplayBatch& replay, SearchStats& stats);

  /// Grows a layer: solves for every action of every node of the beam, replays the best of what
  /// converged and ranks what replays within the gap tolerance. In the states of the best
  /// config.followed steps per place in the beam, what is in place is put where a start like the
  /// target has it (placed()), and they go on with the plan of the node that they were found for;
  /// if none comes to success so, from their own states.
  /// Those that come to success by it come back, of the share config.plans with all that follows
  /// them, and the best of them are the next beam. None begins where the goal holds, as that ends
  /// an episode.
  std::vector<Transition> grow(const SolveBatch& solve, const ReplayBatch& replay,
                               SearchStats& stats);

  /// Least start_distance() of the beam to the target; infinity without a beam.
  double best() const;

  std::span<const Node> nodes() const { return nodes_; }
  std::span<const int> beam() const { return beam_; }  // indices into nodes()

 private:
  std::vector<Predecessor> reverse_layer(const SolveBatch& solve, SearchStats& stats) const;
  std::vector<Predecessor> worth_replaying(std::vector<Predecessor> all) const;
  std::vector<Transition> keep(std::vector<Predecessor> replayed, const ReplayBatch& replay);
  std::vector<Predecessor> best_of(std::vector<Predecessor> steps, int times,
                                   std::unordered_set<std::uint64_t>& seen);
  std::vector<int> plan(const Predecessor& step) const;
  std::vector<std::optional<std::vector<Transition>>> follow(std::vector<Predecessor>& steps,
                                                             const ReplayBatch& replay);
  Poses as_at_a_start(const Poses& poses);
  double distance_left(const Poses& poses) const;
  const Node& node(int k) const { return nodes_[static_cast<std::size_t>(k)]; }

  const tasks::Task& task_;
  const SearchConfig& config_;
  StateMetric metric_;
  Poses target_;
  Rng rng_;
  std::vector<Node> nodes_;
  std::vector<int> beam_;
  std::unordered_set<std::uint64_t> seen_;  // cells of nodes
};

}  // namespace rtg::search

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

  /// Makes the first beam of goal states near the target (goal_roots()), brought to rest by
  /// `replay`.
  void plant(const ReplayBatch& replay, SearchStats& stats);

  /// Grows a layer and returns the transitions to store. Solves for every action of every node of
  /// the beam, replays the best of the converged steps and ranks those that replay within the gap
  /// tolerance. The best config.verified_plans steps per place in the beam are tried: bodies that
  /// are in place in the start of a step are moved to their poses in a start like the target
  /// (placed()), and from there the step and the plan of its parent node are carried out. If no
  /// plan succeeds, all are carried out from the unchanged starts instead. Of each plan that
  /// succeeds, the first transition is returned and, for the share config.whole_plan_share of the
  /// plans, all later ones as well. The best of the successful steps become the next beam. No
  /// transition begins where the goal holds, as that ends an episode.
  std::vector<Transition> grow(const SolveBatch& solve, const ReplayBatch& replay,
                               SearchStats& stats);

  /// Returns the least start_distance() of the beam to the target; infinity if the beam is empty.
  double best() const;

  std::span<const Node> nodes() const { return nodes_; }
  std::span<const int> beam() const { return beam_; }  // indices into nodes()

 private:
  std::vector<Predecessor> reverse_layer(const SolveBatch& solve, SearchStats& stats) const;
  std::vector<Predecessor> best_to_replay(std::vector<Predecessor> all) const;
  std::vector<Transition> keep(std::vector<Predecessor> replayed, const ReplayBatch& replay);
  std::vector<Predecessor> best_of(std::vector<Predecessor> steps, int times,
                                   std::unordered_set<std::uint64_t>& seen);
  std::vector<int> plan(const Predecessor& step) const;
  std::vector<std::optional<std::vector<Transition>>> follow(std::vector<Predecessor>& steps,
                                                             const ReplayBatch& replay);
  Poses with_drawn_start(const Poses& poses);
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

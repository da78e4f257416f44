#pragma once

#include <cstdint>
#include <span>
#include <unordered_set>
#include <vector>

#include "core/math/rng.hpp"
#include "core/search/plan.hpp"
#include "core/search/predecessor.hpp"
#include "core/search/search_config.hpp"
#include "core/search/search_stats.hpp"
#include "core/search/state_metric.hpp"

namespace rtg::search {

/// A state and the first of its actions to success. The node `parent` has the actions that follow.
struct Node {
  Poses poses;
  int action = -1;  // -1: a goal state
  int parent = -1;  // index of the node that `action` leads to
  int depth = 0;    // actions until success
};

/// A beam search backwards in time, from goal states towards a start state (Algorithm 1). Its nodes
/// form a tree. A node's parent is one push nearer to the goal.
class BeamSearch {
 public:
  /// `target`: the start state to reach. `paces`: see GenerationSeams. `task` and `config` must
  /// outlive the search.
  BeamSearch(const tasks::Task& task, const SearchConfig& config, Poses target, std::uint64_t seed,
             std::span<const double> paces = {});

  /// Makes the first beam of goal states near the target (goal_roots()). Lets each state come to
  /// rest by `replay`. Drops states that then are not legal, or no goal states, or in the
  /// cell of another root.
  void make_roots(const ReplayBatch& replay, SearchStats& stats);

  /// Grows a layer of the tree and returns the transitions to store; see grow_together().
  std::vector<Transition> grow(const SolveBatch& solve, const ReplayBatch& replay,
                               SearchStats& stats);

  /// Grows a layer of each of `trees`, which are of one task, and returns the transitions to store,
  /// tree by tree. Each tree grows as it would alone. A batch has the jobs of all trees: those of a
  /// narrow one would leave most workers idle.
  ///
  ///  1. Solve for the predecessors of every node of the beam under every action. Keep the best of
  ///     each solve, those whose starts are nearest to the target.
  ///  2. Select the best config.plans_per_node · config.breadth of them. A plan is such a step
  ///     followed by the actions of its parent node.
  ///  3. Simulate each plan. Objects that are near their start poses first move into a random start
  ///     (snapped_to_start()). If no plan then succeeds, simulate all plans from the unchanged
  ///     states.
  ///  4. Store the first transition of each plan that succeeds. For the share
  ///     config.whole_plan_share of these plans, store all transitions.
  ///  5. Make the best states from which a plan succeeds the next beam.
  ///
  /// No transition begins in a goal state, because episodes end there.
  ///
  /// Departs from the paper: it stores every replayed candidate, as a single step. Here its plan
  /// must succeed, as replay errors add up along it, and some plans are stored whole. On Sorting
  /// success is then 0.99 after 90,000 interactions, without both 0 after 130,000 (one seed).
  /// Without whole plans ArtManip's trees take 2.5 times the CPU time (docs/results/ablations).
  static std::vector<Transition> grow_together(std::span<BeamSearch* const> trees,
                                               const SolveBatch& solve, const ReplayBatch& replay,
                                               SearchStats& stats);

  /// Returns the smallest start_distance() of the beam's nodes; infinity if the beam is empty.
  double min_start_distance() const;

  /// Returns the least depth of a node, but for goal states, with all objects in_place()
  /// of the target; -1 if there is none.
  int start_depth() const;

  const Poses& target() const { return target_; }
  std::span<const Node> nodes() const { return nodes_; }
  std::span<const int> beam() const { return beam_; }  // indices into nodes()

 private:
  /// The plans of a layer. Plan k begins with step k.
  struct Layer {
    std::vector<Predecessor> steps = {};
    std::vector<Poses> found = {};  // starts of the steps, as the solver found them
    std::vector<Plan> plans = {};   // from drawn starts, where the task allows
    std::vector<PlanOutcome> outcomes = {};
  };

  std::vector<reverse::ReverseJob> reverse_jobs() const;
  std::vector<Predecessor> nearest_steps(std::span<const reverse::ReverseJob> jobs,
                                         std::span<const reverse::ReverseResult> answers,
                                         SearchStats& stats) const;
  std::vector<Predecessor> best_of(std::vector<Predecessor> steps, int times,
                                   std::unordered_set<std::uint64_t>& seen) const;
  Layer with_plans(std::vector<Predecessor> steps);
  static void simulate(std::vector<Layer>& layers, const tasks::Task& task,
                       const ReplayBatch& replay);
  static void count_gaps(const Layer& layer, SearchStats& stats);
  std::vector<Transition> to_store(std::span<const PlanOutcome> outcomes);
  void make_next_beam(Layer layer);
  std::vector<int> plan(const Predecessor& step) const;
  Poses with_drawn_start(const Poses& poses);
  const Node& node(int k) const { return nodes_[static_cast<std::size_t>(k)]; }

  const tasks::Task& task_;
  const SearchConfig& config_;
  StateMetric metric_;
  Poses target_;
  Rng rng_;
  std::vector<Node> nodes_;
  std::vector<int> beam_;
  std::unordered_set<std::uint64_t> seen_;  // StateMetric::cell() of each node
};

}  // namespace rtg::search

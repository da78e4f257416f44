#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/search/beam_search.hpp"
#include "core/search/generate.hpp"
#include "core/search/roll_out.hpp"
#include "core/search/step_pool.hpp"
#include "core/search/tree_policy.hpp"

namespace rtg {

/// Rounds of trees of reverse steps, and the policy that follows their plans.
class Exploration {
 public:
  /// Called after each layer: its number, and the steps found since the last call are those of
  /// pool() from index `first` on.
  using AfterLayer = std::function<void(int layer, std::size_t first)>;

  /// All arguments must outlive it; `stats` counts what it does.
  Exploration(const Task& task, const SearchConfig& config, std::uint64_t seed,
              const GenerationSeams& seams, SearchStats& stats);

  /// One round: trees grow to where the policy gets lost, or to a jittered start if it does not
  /// (once it solves every probe, also to the angles, for the start region's sake), until the pool
  /// has `limit` steps. The policy takes up what they find if it does better with it. Whether
  /// anything was found.
  bool round(std::size_t limit, const AfterLayer& after_layer);

  /// Steps that follow on each other and end in success, or short of it: the pool and, if they
  /// succeed, the policy take them up.
  void add_plan(std::span<const Transition> steps);

  /// Rounds in a row, the last ones, at whose beginning the policy solved every probe.
  int mastered() const { return mastered_; }

  int rounds() const { return rounds_; }
  StepPool& pool() { return pool_; }
  TreePolicy& policy() { return policy_; }

  /// All nodes, and the least depth of one in the start region but for goals; -1: there is none.
  const std::vector<ReportNode>& nodes() const { return nodes_; }
  int start_region_depth() const { return start_region_depth_; }

 private:
  void grow_towards(const Target& target, int breadth, std::size_t limit,
                    const AfterLayer& after_layer);
  std::vector<Poses> probe_starts(std::uint64_t stream) const;
  std::vector<Episode> follow(const TreePolicy& policy, std::span<const Poses> starts);
  void improve_policy(int proven, std::span<const Poses> starts, double before);
  int arrivals(std::size_t first, const Poses& target) const;
  void note_nodes(std::size_t first);
  void add(std::span<const BeamSearch::Growth> growths);
  void learn(const BeamSearch::Growth& growth);
  void replay_chains_from(std::size_t first, std::size_t before, std::size_t limit);
  bool cancelled() const { return seams_.cancelled && seams_.cancelled(); }

  const Task& task_;
  const SearchConfig& config_;
  std::uint64_t seed_;
  const GenerationSeams& seams_;
  SearchStats& stats_;
  StateMetric metric_;
  BeamSearch search_;
  StepPool pool_;
  TreePolicy policy_;
  std::vector<ReportNode> nodes_;
  int start_region_depth_ = -1;
  int rounds_ = 0, mastered_ = 0;
};

}  // namespace rtg

#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <unordered_set>
#include <vector>

#include "core/search/forward_replay.hpp"
#include "core/search/ranking.hpp"
#include "core/search/search_config.hpp"
#include "core/search/search_stats.hpp"
#include "core/search/state_metric.hpp"
#include "core/search/stretch_probe.hpp"

namespace rtg {

/// A state from which `depth` known actions lead to success.
struct Node {
  Poses poses;
  int parent = -1;  // node that `action` leads to; -1: a goal state
  int action = -1;
  int depth = 0;
};

/// Trees of reverse steps, grown layer by layer from goal states (Algorithm 1) towards one target
/// after the other.
class BeamSearch {
 public:
  /// The task must outlive the search.
  BeamSearch(const Task& task, const SearchConfig& config, std::uint64_t seed);

  /// Heads for `target`, `breadth` nodes per layer: plants up to as many distinct goal states of
  /// the task's sampler, brought to rest by `replay`: the ones nearest to the target among
  /// `config.root_draws` times as many, objects that look the same exchanged so that each begins
  /// near its place. The next layer grows from those of all nodes that start_distance() puts
  /// nearest, whatever the ranking: the others judge a step, and an old node is none.
  void aim(const Target& target, int breadth, const ReplayBatch& replay, SearchStats& stats);

  /// A replayed candidate with the node that it came from.
  struct Growth {
    Predecessor candidate;  // parent: index into nodes()
    int depth = 0;        // actions to success of its start, if it is expanded further
  };

  /// One layer: solves for every action of every node of the beam, replays what converged, chooses
  /// the next beam. Nothing can follow a plan through a push that turns an object or stretches
  /// errors by more than the tolerances (repeatable()): it is no better than one that misses.
  /// All replayed candidates come back, these too; empty if the tree cannot grow.
  std::vector<Growth> grow(const SolveBatch& solve, const ReplayBatch& replay, SearchStats& stats);

  /// Least start_distance() of the beam to the target, whatever the ranking; infinity without a
  /// beam.
  double best() const { return best_; }

  std::span<const Node> nodes() const { return nodes_; }
  std::span<const int> beam() const { return beam_; }  // indices into nodes()

  /// The actions that lead from a node to success.
  Chain chain(int node) const;

 private:
  void plant(const ReplayBatch& replay, SearchStats& stats);
  std::vector<ReverseJob> jobs() const;
  Score layer_score() const;
  std::vector<Predecessor> worth_replaying(std::vector<Predecessor> all, const Score& score) const;
  void advance(std::span<const Growth> growths, const Score& score);
  double distance_left(const Poses& poses) const;
  void note_best();

  const Task& task_;
  SearchConfig config_;
  StateMetric metric_;
  Target target_;
  Rng rng_;
  StretchProbe probe_;
  std::vector<Node> nodes_;
  std::vector<int> beam_;
  double best_ = std::numeric_limits<double>::infinity();
  std::unordered_set<std::uint64_t> seen_;
};

}  // namespace rtg

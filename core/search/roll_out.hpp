#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/search/batches.hpp"
#include "core/search/search_stats.hpp"
#include "core/search/transition.hpp"
#include "core/search/tree_policy.hpp"

namespace rtg {

/// One episode of the tree policy.
struct Episode {
  std::vector<Transition> steps;    // source kRollOut
  std::vector<double> strayed;      // distance from the policy's entry at each step [m]
  std::vector<std::uint64_t> used;  // TreePolicy::key() of these entries
  bool success = false;
};

/// Episodes to be played, one from each start.
struct EpisodePlan {
  std::span<const Poses> starts;
  double noise = 0.0;      // share of actions replaced by a neighbouring heading, ±1 or ±2
  std::uint64_t seed = 0;  // of the noise; episode k uses a stream of its own
};

/// Follows the policy from every start until success, the task's horizon or a push that the
/// simulator rejects. All episodes advance in lockstep, one batch of replays per step; each is a
/// function of its start and number only.
std::vector<Episode> run_episodes(const Task& task, const TreePolicy& policy,
                                  const EpisodePlan& plan, const ReplayBatch& replay,
                                  SearchStats& stats);

/// Further than this from the entry that it follows a policy is lost [m], in its own metric.
inline constexpr double kLost = 1.0;

/// Start states with object positions moved by up to ± an amplitude drawn from [0, amplitude] for
/// each state.
std::vector<Poses> jittered_starts(const Task& task, int count, double amplitude, Rng& rng);

/// How the policy does from `starts`, without noise.
struct PolicyScore {
  double success = 0.0;      // share of the episodes
  double length_mean = 0.0;  // actions, over all episodes
};
PolicyScore evaluate_policy(const Task& task, const TreePolicy& policy,
                            std::span<const Poses> starts, const ReplayBatch& replay,
                            SearchStats& stats);

}  // namespace rtg

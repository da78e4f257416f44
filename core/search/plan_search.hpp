#pragma once

#include <span>
#include <vector>

#include "core/search/batches.hpp"
#include "core/search/search_stats.hpp"
#include "core/search/transition.hpp"
#include "core/search/tree_policy.hpp"

namespace rtg {

/// Plans found forwards, in the simulator, with the policy for a guide: from each of `starts` a
/// beam search in which
///
///   TreePolicy::alternatives   says which actions are tried from a state,
///   the score of its choice    how far from success a state is, its cost to go.
///
/// Where following the policy goes astray, one of the few states kept after each action mostly
/// comes back to what its entries know. Per start the steps of the first plan that succeeds (source
/// kMended), none if there is no such plan within the task's horizon, or if many actions bring no
/// state nearer to success. All beams advance in lockstep, one batch of replays per action; each is
/// a function of its start only.
std::vector<std::vector<Transition>> search_plans(const Task& task, const TreePolicy& policy,
                                                  std::span<const Poses> starts,
                                                  const ReplayBatch& replay, SearchStats& stats);

}  // namespace rtg

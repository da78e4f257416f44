#pragma once

#include <vector>

#include "core/search/search_config.hpp"
#include "core/search/search_stats.hpp"
#include "core/search/start_distance.hpp"
#include "core/tasks/task.hpp"

namespace rtg::search {

/// Poses of bodies that look the same (equal kind, shape, density and friction) exchanged so that
/// the layout is as near as possible to `target` (pairwise exchanges until none helps). Whether a
/// goal holds cannot depend on which of them is which.
Poses relabelled(const tasks::Task& task, const Poses& poses, const Poses& target);

/// Up to config.breadth distinct goal states of the task's sampler, relabelled: of
/// config.root_draws times as many draws those of least start_distance to `target`. Not yet at
/// rest.
std::vector<Poses> goal_roots(const tasks::Task& task, const SearchConfig& config,
                              const Poses& target, Rng& rng, SearchStats& stats);

}  // namespace rtg::search

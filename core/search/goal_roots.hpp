#pragma once

#include <vector>

#include "core/search/search_config.hpp"
#include "core/search/search_stats.hpp"
#include "core/search/start_distance.hpp"
#include "core/tasks/task.hpp"

namespace rtg::search {

/// Returns `poses` after exchanging the poses of bodies that look the same, so that the layout is
/// as near as possible to `target` (pairwise exchanges until none helps). Bodies look the same if
/// their kind, shape, density and friction are equal and they can move and have no joint. Whether a
/// goal holds does not depend on such an exchange.
Poses relabelled(const tasks::Task& task, const Poses& poses, const Poses& target);

/// Returns up to config.breadth distinct goal states, relabelled() and not yet at rest: of
/// config.breadth · config.root_draws draws of sample_goal() those of least start_distance() to
/// `target`.
std::vector<Poses> goal_roots(const tasks::Task& task, const SearchConfig& config,
                              const Poses& target, Rng& rng, SearchStats& stats);

}  // namespace rtg::search

#pragma once

#include <optional>
#include <vector>

#include "core/search/search_config.hpp"
#include "core/search/search_stats.hpp"
#include "core/search/start_distance.hpp"
#include "core/search/state_metric.hpp"
#include "core/tasks/task.hpp"

namespace rtg::search {

/// Swaps the poses of interchangeable() objects until no swap reduces the layout_distance() to
/// `target`. Returns the result.
Poses with_swapped_twins(const tasks::Task& task, const StateMetric& metric, const Poses& poses,
                         const Poses& target);

/// Nodes of a full beam per root. With a root for each, the first layer takes three times as long,
/// as its objects touch, and Gathering is learned no faster (three seeds).
inline constexpr int kNodesPerRoot = 4;

/// Draws a goal state by sample_goal() and counts the draw in `stats`.
std::optional<Poses> drawn_goal(const tasks::Task& task, Rng& rng, SearchStats& stats);

/// Draws goal states and returns up to config.breadth / kNodesPerRoot (rounded up) distinct ones,
/// the nearest to `target` by start_distance() with `metric`, with its angle of the robot. Makes at
/// most config.breadth · config.root_draws draws by sample_goal() and applies with_swapped_twins()
/// to each state. The states are not yet at rest. Counts failed draws in `stats`.
std::vector<Poses> goal_roots(const tasks::Task& task, const SearchConfig& config,
                              const StateMetric& metric, const Poses& target, Rng& rng,
                              SearchStats& stats);

}  // namespace rtg::search

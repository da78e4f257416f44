#pragma once

#include <functional>
#include <span>

#include "core/search/forward_replay.hpp"
#include "core/search/search_config.hpp"
#include "core/search/state_metric.hpp"

namespace rtg {

/// Where a tree should grow to: its score is the least there.
///
///   start_distance: Σ_objects (|x - x*| + r|θ - θ*|) + 0.12 · way of the robot to its next
///   contact,
///
/// x*, θ* the layout `target`, r as in StateMetric. The next contact: the robot stands ahead of
/// an object on the line to its place x*, ready to pull it there; with all objects in place, the
/// robot's own place.
///   novelty:      how many of the tree's states share the coarse cell of the state
///   displacement: - how far the step moved the objects, in all [m]
using Score = std::function<double(const Candidate&)>;

/// `target` is the layout to reach, `known` the states that the tree has; both are copied.
Score make_score(Ranking ranking, const Task& task, const Poses& target,
                 std::span<const Poses> known);

/// The first score on its own, for choosing roots.
double start_distance(const Task& task, const StateMetric& metric, const Poses& poses,
                      const Poses& target);

}  // namespace rtg

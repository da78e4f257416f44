#pragma once

#include <functional>
#include <span>

#include "core/search/forward_replay.hpp"
#include "core/search/search_config.hpp"
#include "core/search/state_metric.hpp"

namespace rtg {

/// Where trees grow to.
struct Target {
  Poses poses;          // the layout
  double turned = 0.0;  // an object 1 rad off its angle counts as this far out of its place [m]
};

/// Where a tree should grow to: its score is the least there.
///
///   start_distance: about how many pushes are left,
///
///     Σ_objects [(|x - x*| + r|θ - θ*|) / stride
///                + 2·min(1, (|x - x*| + turned·|θ - θ*|) / 0.4 m)] + walk,
///
/// x*, θ*, turned of the target, r as in StateMetric; 2 is the price of getting from one object to
/// the next. `walk`: pushes until the robot touches an object that is out of place, whatever its
/// angle, on the side towards its place, ready to pull it there (0, 1, or the strides of the way,
/// but at least 2); with all objects in place, the way to the robot's own, in strides.
///   novelty:      how many of the tree's states share the coarse cell of the state
///   displacement: - how far the step moved the objects, in all [m]
using Score = std::function<double(const Predecessor&)>;

/// `known`: the states that the trees have; only novelty looks at them. They and `target` are
/// copied.
Score make_score(Ranking ranking, const Task& task, const Target& target,
                 std::span<const Poses> known);

/// The first score on its own: chooses the roots and the beam of a new round, tells its progress.
double start_distance(const Task& task, const StateMetric& metric, const Poses& poses,
                      const Target& target);

}  // namespace rtg

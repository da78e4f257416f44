#pragma once

#include "core/search/state_metric.hpp"
#include "core/tasks/task.hpp"

namespace rtg {

/// About how many pushes a state is from `target`, which a tree grows to:
///
///   Σ_objects [(|x - x*| + r|θ - θ*|) / stride + 2·min(1, |x - x*| / 0.4 m)] + walk,
///
/// x*, θ* of the target, r as in StateMetric; 2 is the price of getting from one object to the
/// next. `walk`: pushes until the robot touches an object that is out of place, whatever its angle,
/// on the side towards its place, ready to pull it there (0, 1, or the strides of the way, but at
/// least 2); with all objects in place, the way to the robot's own, in strides.
double start_distance(const Task& task, const StateMetric& metric, const Poses& poses,
                      const Poses& target);

}  // namespace rtg

#pragma once

#include "core/search/state_metric.hpp"
#include "core/tasks/task.hpp"

namespace rtg::search {

/// About how many pushes a state is from `target`, which a tree grows to:
///
///   Σ_objects out of place [(|x - x*| + r|θ - θ*|) / stride + 2] + walk,
///
/// x*, θ* of the target, r as in StateMetric; an object is in place within 0.4 m of x*, one with
/// a joint where |x - x*| + r|θ - θ*| is at most that; 2 is the price of getting from one object to
/// the next. `walk`: pushes until the robot touches an object
/// that is out of place, whatever its angle, on the side towards its place, ready to pull it there
/// (0, 1, or the strides of the way, but at least 2); with all objects in place, likewise until it
/// is within 0.4 m of its own place. At 0, placed() gives a whole start.
double start_distance(const tasks::Task& task, const StateMetric& metric, const Poses& poses,
                      const Poses& target);

/// Says whether all objects are in place; the robot may be anywhere.
bool in_place(const StateMetric& metric, const Poses& poses, const Poses& target);

/// `poses` with every object that is in place put where `start` has it, which is like `target`;
/// what joints connect once all of it is in place, the robot once all objects and it are.
Poses placed(const tasks::Task& task, const StateMetric& metric, Poses poses, const Poses& target,
             const Poses& start);

}  // namespace rtg::search

#pragma once

#include "core/search/state_metric.hpp"
#include "core/tasks/task.hpp"

namespace rtg::search {

/// Estimates how many pushes a state is away from `target`, the start towards which a tree grows:
///
///   Σ_objects out of place [(|x - x*| + r|θ - θ*|) / stride + 2] + walk,
///
/// with x*, θ* of the target and r as in StateMetric. An object is in place within 0.4 m of x*; an
/// object with a joint is if |x - x*| + r|θ - θ*| ≤ 0.4 m. 2 is the price of getting from one
/// object to the next. `walk` is the number of pushes until the robot touches an object that is out
/// of place on the side towards its place, ready to pull it there at any angle: 0, 1, or the
/// distance in strides, but at least 2. With all objects in place, `walk` is, likewise, the number
/// of pushes until the robot is within 0.4 m of its own place. At distance 0, placed() returns a
/// whole start.
double start_distance(const tasks::Task& task, const StateMetric& metric, const Poses& poses,
                      const Poses& target);

/// Returns whether all objects are in place; the robot may be anywhere.
bool in_place(const StateMetric& metric, const Poses& poses, const Poses& target);

/// Returns `poses` with every object that is in place moved to its pose in `start`, a start like
/// `target`. Bodies that joints connect are moved only if all of them are in place; the robot is
/// moved only if all objects and the robot are.
Poses placed(const tasks::Task& task, const StateMetric& metric, Poses poses, const Poses& target,
             const Poses& start);

}  // namespace rtg::search

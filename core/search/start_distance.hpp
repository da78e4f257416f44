#pragma once

#include "core/search/state_metric.hpp"
#include "core/tasks/task.hpp"

namespace rtg::search {

/// Estimates the number of pushes between `poses` and the start state `target`:
///
///   Σ_objects out of place [2 + (|h - x| + (|x - x*| + r|θ - θ*|) / σ + |x* - h|) / stride]
///     + min_objects out of place [approach_pushes - |h - x| / stride]
///
/// h is the robot's own place. So the robot goes to an object, takes it to its place, goes home and
/// from there to the next. This is more than it needs, but an object that comes into place is
/// progress in whatever order and however far the next is: the triangle inequality.
///
/// Gates (StateMetric::gates()) that are in the way of an object that is out of place, wherever
/// they are, have to be opened and shut again. Both are in the sum, and the robot goes to them
/// first to pull them open, as far as their joint allows.
///
/// σ is the pace of a push of the object (StateMetric::Object::pace): a push moves a heavy one by
/// less than a stride.
///
/// All lengths are those of the shortest ways around fixed bodies (StateMetric::way()), |x - x*|
/// also around gates. The way in which an object is to be pulled is the first piece of that.
///
/// The place of an object is its pose x*, θ* in `target`; r is that of StateMetric. The object is
/// in place if |x - x*| ≤ 0.4 m or, with a joint, if |x - x*| + r|θ - θ*| ≤ 0.4 m. The 2 is about
/// the number of pushes that take the robot from one side of an object to another.
///
/// `approach_pushes` is the number of pushes until the robot can pull the object. (Seen backwards
/// in time, a push pulls.) It can if it touches the object on the side towards the place. If all
/// objects are in place, `approach_pushes` is the number of pushes until the robot is within 0.4 m
/// of its own place, and that is all. `approach_pushes` is 0, 1, or the distance in strides, at
/// least 2.
///
/// At distance 0, snapped_to_start() returns its argument `start`.
double start_distance(const tasks::Task& task, const StateMetric& metric, const Poses& poses,
                      const Poses& target);

/// Returns whether every object is near its pose in `target`, as start_distance() defines "in
/// place". The robot may be anywhere.
bool in_place(const StateMetric& metric, const Poses& poses, const Poses& target);

/// Returns whether every object is in place of a start of the task: near its pose in task.start, or
/// within 0.4 m of the region that it starts in and 0.8 rad of the angles.
bool in_start_region(const tasks::Task& task, const StateMetric& metric, const Poses& poses);

/// Returns `poses` with each object that is near its pose in `target` (in place, start_distance())
/// moved to its pose in `start`, a start state near `target`. Bodies connected by joints, except
/// through a fixed body, move only if all of them are in place. The robot moves only if it and all
/// objects are in place.
///
/// Departs from the paper: its trees leave the states as the reverse steps find them. Here objects
/// in place move on to a drawn start: else they are up to 0.4 m off, alike in all nodes of a tree,
/// and the learned values of starts were a fifth of the true ones.
Poses snapped_to_start(const tasks::Task& task, const StateMetric& metric, Poses poses,
                       const Poses& target, const Poses& start);

}  // namespace rtg::search

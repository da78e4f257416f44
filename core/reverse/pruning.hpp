#pragma once

#include <vector>

#include "core/reverse/problem/reverse_job.hpp"
#include "core/world/push.hpp"
#include "core/world/scene.hpp"

namespace rtg::reverse {

/// Returns the area that a body sweeps over on a straight way: the convex hull of `shape` and of
/// `shape` moved by `by` (world frame), in the body's frame at heading `theta`.
Polygon swept(const Polygon& shape, double theta, const Vector2d& by);

/// Returns whether the action cannot have been the last one, as the robot's straight way back
/// leaves the arena or passes through a body behind the robot. A link may lie on the way as far as
/// it can have swung in since. The test is very cheap compared with a solve.
bool is_pruned(const Scene& scene, const PushConfig& push, const ReverseJob& job);

/// Returns the bodies that can take part in the push: the robot first, movable bodies before fixed
/// ones. They are the bodies within about `range` [m] of the robot's way one stride back, those
/// within that distance of the equal way of another movable body found, and those that joints
/// connect with one.
std::vector<int> relevant_bodies(const Scene& scene, const PushConfig& push, const ReverseJob& job,
                                 double range);

}  // namespace rtg::reverse

#pragma once

#include <vector>

#include "core/reverse/problem/reverse_job.hpp"
#include "core/world/push.hpp"
#include "core/world/scene.hpp"

namespace rtg::reverse {

/// The convex hull of a body and of itself moved by `by` (world frame), in the body's frame at
/// heading `theta`: what it sweeps over on a straight way.
Polygon swept(const Polygon& shape, double theta, const Vector2d& by);

/// Says whether the action cannot have been the last one: the robot's straight way back leaves the
/// arena or passes through a body behind it (through a link by more than it can have swung in
/// since). Costs nothing next to a solve.
bool is_pruned(const Scene& scene, const PushConfig& push, const ReverseJob& job);

/// The bodies that can take part in the push, robot first, movable ones before fixed ones: those
/// within `range` [m] of the robot's way, and of the ways of such bodies, one stride back.
std::vector<int> relevant_bodies(const Scene& scene, const PushConfig& push, const ReverseJob& job,
                                 double range);

}  // namespace rtg::reverse

#pragma once

#include <vector>

#include "core/reverse/problem/reverse_job.hpp"
#include "core/world/push.hpp"
#include "core/world/scene.hpp"

namespace rtg::reverse {

/// Returns the area that `shape` sweeps over while it moves by `by` (world frame): for each part
/// the convex hull of its first and last position. The area is in the body frame, which is turned
/// by `theta`.
std::vector<Part> swept(const Shape& shape, double theta, const Vector2d& by);

/// Returns whether `job.action` cannot have led to `job.end`. This is so if the robot's straight
/// way back leaves the arena or passes through a body. A movable body with a joint may reach 0.75 m
/// into the way, as it may have swung in behind the robot. The test is very cheap compared with a
/// solve.
///
/// Departs from the paper: it solves for all headings. Candidates like these never converge, and
/// each of them would take all iterations that a solve may take. Of 1,000 true pushes 8 are pruned:
/// a link swung farther or pushed a loose body in behind the robot, or the robot's way was bent at
/// the edge of the arena. If movable bodies prune nothing in scenes with joints, ArtManip's trees
/// take 2.3 times the CPU and get no further state.
bool is_pruned(const Scene& scene, const PushConfig& push, const ReverseJob& job);

/// Returns the indices of the bodies that can take part in the push: the robot first, movable
/// bodies before fixed ones. The set begins with the robot. Each movable body in it adds
///
///   - The bodies within `range` [m] of the area that it sweeps in one stride back. An object also
///     gets a margin for turns, and a body with a joint one stride, because links swing.
///   - The bodies that joints connect with it.
///
/// Departs from the paper: it solves for all bodies. With the finite range of the barrier the
/// others stay where they are, to the bit.
std::vector<int> relevant_bodies(const Scene& scene, const PushConfig& push, const ReverseJob& job,
                                 double range);

}  // namespace rtg::reverse

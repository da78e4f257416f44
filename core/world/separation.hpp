#pragma once

#include <optional>
#include <utility>

#include "core/world/scene.hpp"

namespace rtg {

/// Separating-axis separation of two convex polygons [m]: the largest edge-normal gap
///
///   s = max over the edges n of either polygon of  min_v n·v - b.
///
/// s > 0 certifies that they do not overlap; otherwise -s bounds the penetration depth. Unlike
/// vertex distances, s also detects bars that cross with no vertex of one inside the other.
double separation(const Polygon& a, const Pose& pose_a, const Polygon& b, const Pose& pose_b);

/// Returns whether an edge separates the polygons by `margin` [m] or more: separation() ≥ margin.
bool are_apart(const Polygon& a, const Pose& pose_a, const Polygon& b, const Pose& pose_b,
               double margin);

/// Returns the distance of x from the segment from a to b [m].
double distance_to_segment(const Vector2d& x, const Vector2d& a, const Vector2d& b);

/// Returns the first pair of bodies closer than `margin` [m], or nothing. Ignores pairs of fixed
/// bodies and pairs that a joint connects.
std::optional<std::pair<std::size_t, std::size_t>> first_overlap(const Scene& scene,
                                                                 const Poses& poses,
                                                                 double margin = 0.0);

}  // namespace rtg

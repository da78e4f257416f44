#pragma once

#include <optional>
#include <utility>

#include "core/world/scene.hpp"

namespace rtg {

/// Separating-axis separation of two convex polygons [m]: the largest edge-normal gap
///
///   s = max over the edges n of either polygon of  min_v n·v - b.
///
/// s > 0 certifies that they do not overlap; -s bounds the penetration depth otherwise. Unlike
/// vertex distances it also sees crossing bars.
double separation(const Polygon& a, const Pose& pose_a, const Polygon& b, const Pose& pose_b);

/// Says whether an edge separates them by `margin` [m] or more: separation() ≥ margin.
bool are_apart(const Polygon& a, const Pose& pose_a, const Polygon& b, const Pose& pose_b,
               double margin);

/// Distance of x from the segment from a to b [m].
double distance_to_segment(const Vector2d& x, const Vector2d& a, const Vector2d& b);

/// The first pair of bodies closer than `margin` [m] (two that are fixed, or jointed, may be), or
/// nothing.
std::optional<std::pair<std::size_t, std::size_t>> first_overlap(const Scene& scene,
                                                                 const Poses& poses,
                                                                 double margin = 0.0);

}  // namespace rtg

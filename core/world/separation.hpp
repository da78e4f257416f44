#pragma once

#include <optional>
#include <span>
#include <utility>

#include "core/world/scene.hpp"

namespace rtg {

/// Returns the separation s of two convex parts [m]. That of two polygons is that of the
/// separating-axis test,
///
///   s = max over the edges n·x = b of either polygon of  min_v n·v - b.
///
/// n is the outward unit normal of the edge, v runs over the vertices of the other polygon. s > 0
/// certifies that the polygons do not overlap; otherwise -s bounds the penetration depth. s also
/// detects crossed bars, of which neither contains a vertex of the other.
///
/// If a part has a radius, s is the distance of the cores minus both radii. Where the cores overlap
/// the separating-axis test takes the place of their distance.
double separation(const Part& a, const Pose& pose_a, const Part& b, const Pose& pose_b);

/// Returns the least separation of a part of one body and a part of the other [m].
double separation(std::span<const Part> a, const Pose& pose_a, std::span<const Part> b,
                  const Pose& pose_b);
inline double separation(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b) {
  return separation(a.parts(), pose_a, b.parts(), pose_b);
}

/// Returns whether separation() ≥ `margin` [m]. This is faster than computing the separation.
bool are_apart(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
               double margin);

/// Returns the distance of x from the segment from a to b [m].
double distance_to_segment(const Vector2d& x, const Vector2d& a, const Vector2d& b);

/// Returns the first pair of bodies that are less than `margin` [m] apart, or nothing. Ignores
/// pairs of fixed bodies and pairs that a joint connects.
std::optional<std::pair<std::size_t, std::size_t>> first_overlap(const Scene& scene,
                                                                 const Poses& poses,
                                                                 double margin = 0.0);

}  // namespace rtg

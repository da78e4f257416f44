#pragma once

#include "core/world/shape.hpp"

namespace rtg {

/// Returns the part of a convex, counter-clockwise polygon that lies at least `by` [m] within all
/// its edges; without vertices if there is none. `by` must not be negative.
std::vector<Vector2d> inset_ring(std::span<const Vector2d> ring, double by);

/// Returns the area that two convex, counter-clockwise polygons have in common [m²]. Both are in
/// one frame.
double common_area(std::span<const Vector2d> a, std::span<const Vector2d> b);

/// Returns the share of the area of `shape` at the pose `target` that the shape covers at the pose
/// `at`.
double covered_share(const Shape& shape, const Pose& at, const Pose& target);

}  // namespace rtg

#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/world/shape.hpp"

namespace rtg {

/// Areas of several convex parts together, by the library GEOS. Its polygons have no arcs: round
/// corners are polygons of 512 sides per turn, which have 3e-5 less area.

/// Returns the area integrals of the union of `parts`.
Moments union_moments(std::span<const Part> parts);

/// Returns the outline of the union of `parts`, for pictures: its outer ring, then those of holes.
/// Round corners have 64 sides per turn; where that leaves several pieces, the rings of each
/// follow. A single sharp part is returned as it is.
std::vector<std::vector<Vector2d>> outline(std::span<const Part> parts);

/// Returns whether the union of `parts` is in one piece. Gaps of less than 1e-7 of the largest
/// distance from the origin count as none, a common corner alone does not connect.
bool in_one_piece(std::span<const Part> parts);

/// Returns whether a turn by `angle` about the origin maps the union of `parts` onto itself.
bool maps_onto_itself(std::span<const Part> parts, double angle);

/// Returns a point where the closed line through the vertices of `ring` crosses or touches itself;
/// nothing if the ring is a simple polygon, of either orientation.
std::optional<Vector2d> self_contact(std::span<const Vector2d> ring);

/// Splits the union of `parts` into convex polygons of at most 64 vertices that do not overlap; a
/// single part is one polygon. Round corners have 64 sides per turn.
std::vector<Polygon> disjoint_pieces(std::span<const Part> parts);

/// Splits the simple polygon `ring` into convex polygons of at most kMaxVertices vertices: its
/// constrained Delaunay triangles, of which neighbours are merged while the result is convex.
std::vector<Polygon> convex_pieces(std::span<const Vector2d> ring);

}  // namespace rtg

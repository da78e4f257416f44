#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/world/pose.hpp"

namespace rtg {

/// Convex polygon with counter-clockwise vertices [m].
struct Polygon {
  std::vector<Vector2d> vertices;

  bool operator==(const Polygon&) const = default;
  std::size_t size() const { return vertices.size(); }
};

/// Largest number of vertices of a polygon; also Box2D's limit.
inline constexpr std::size_t kMaxVertices = 8;

/// Moments of an area of unit density.
struct Moments {
  double area = 0.0;                     // [m²]
  Vector2d centroid = Vector2d::Zero();  // [m]
  double polar = 0.0;                    // ∫|x - centroid|² dx [m⁴]
};

/// Integrals over an area, which can be added.
struct AreaIntegrals {
  double area = 0.0;                  // ∫dx [m²]
  Vector2d first = Vector2d::Zero();  // ∫x dx [m³]
  double second = 0.0;                // ∫|x|² dx [m⁴]

  void add(const AreaIntegrals& other, double weight = 1.0);
  Moments moments() const;
};

/// Returns the integrals over the polygon with these vertices; negative ones if it is clockwise.
AreaIntegrals area_integrals(std::span<const Vector2d> ring);

Moments moments(const Polygon& shape);

/// Returns nothing if `vertices` is a legal shape, otherwise a message to the user that says why
/// not. Reasons: too few or too many vertices, not finite, clockwise, not convex, degenerate.
/// `metre`: unit of the vertices, for the message [m].
std::optional<std::string> polygon_defect(std::span<const Vector2d> vertices, double metre = 1.0);

/// Returns the same shape with its centroid at the origin.
Polygon centred(const Polygon& shape);

/// Returns the largest distance of a vertex from the body origin [m].
double bounding_radius(const Polygon& shape);

/// Returns the outward unit normal of the edge that begins at vertex k.
Vector2d edge_normal(const Polygon& polygon, std::size_t k);

Polygon box(double width, double height);
Polygon regular_polygon(int sides, double circumradius);

/// Returns the polygon with all edges moved outwards by `by` [m]. Corners are mitred: edges are
/// extended until they meet, so that sharp corners extend far.
Polygon offset_polygon(const Polygon& polygon, double by);

/// Returns the largest k such that turning `shape` about its origin by 2π/k maps it onto itself.
int symmetry_order(const Polygon& shape);

}  // namespace rtg

#include "core/world/polygon.hpp"

#include <algorithm>
#include <cstdio>
#include <numbers>

namespace rtg {
namespace {

constexpr double kMinEdge = 0.005;   // Box2D merges vertices closer than its linear slop [m]
constexpr double kMinArea = 1e-4;    // [m²]
constexpr double kMaxExtent = 1000;  // [m]

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

std::string vertex_name(std::size_t k) { return "vertex " + std::to_string(k); }

std::string in_metres(double length) {
  char text[32];
  std::snprintf(text, sizeof text, "%g m", length);
  return text;
}

bool maps_onto_itself(const Polygon& shape, std::size_t shift, double tolerance) {
  const double angle =
      2.0 * std::numbers::pi * static_cast<double>(shift) / static_cast<double>(shape.size());
  for (std::size_t k = 0; k < shape.size(); ++k) {
    const Vector2d turned = rotate(angle, shape.vertices[k]);
    if ((turned - shape.vertices[(k + shift) % shape.size()]).norm() > tolerance) return false;
  }
  return true;
}

}  // namespace

void AreaIntegrals::add(const AreaIntegrals& other, double weight) {
  area += weight * other.area;
  first += weight * other.first;
  second += weight * other.second;
}

Moments AreaIntegrals::moments() const {
  const Vector2d centroid = first / area;
  return {area, centroid, second - area * centroid.squaredNorm()};
}

AreaIntegrals area_integrals(std::span<const Vector2d> ring) {
  AreaIntegrals sum;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const Vector2d &v = ring[k], &w = ring[(k + 1) % ring.size()];
    const double c = cross(v, w);
    sum.area += c / 2.0;
    sum.first += c / 6.0 * (v + w);
    sum.second += c / 12.0 * (v.dot(v) + v.dot(w) + w.dot(w));
  }
  return sum;
}

Moments moments(const Polygon& shape) { return area_integrals(shape.vertices).moments(); }

std::optional<std::string> polygon_defect(std::span<const Vector2d> vertices, double metre) {
  const std::size_t n = vertices.size();
  if (n < 3 || n > kMaxVertices)
    return "has " + std::to_string(n) + " vertices, not 3 to " + std::to_string(kMaxVertices);
  for (std::size_t k = 0; k < n; ++k)
    if (!vertices[k].allFinite() || vertices[k].cwiseAbs().maxCoeff() > kMaxExtent)
      return vertex_name(k) + " is not finite or beyond " + in_metres(kMaxExtent * metre);
  double area = 0.0, turning = 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    const Vector2d edge = vertices[(k + 1) % n] - vertices[k];
    const Vector2d next = vertices[(k + 2) % n] - vertices[(k + 1) % n];
    if (edge.norm() < kMinEdge)
      return "edge at " + vertex_name(k) + " is shorter than " + in_metres(kMinEdge * metre);
    turning += angle_of(edge.dot(next), cross(edge, next));
    area += cross(vertices[k], vertices[(k + 1) % n]) / 2.0;
  }
  if (area < 0.0) return "is clockwise; list the vertices counter-clockwise";
  for (std::size_t k = 0; k < n; ++k) {
    const Vector2d edge = vertices[(k + 1) % n] - vertices[k];
    const Vector2d next = vertices[(k + 2) % n] - vertices[(k + 1) % n];
    if (cross(edge, next) <= 1e-6 * edge.norm() * next.norm())
      return "is not strictly convex at " + vertex_name((k + 1) % n);
  }
  if (std::abs(turning - 2.0 * std::numbers::pi) > 1e-6) return "crosses itself";
  if (area < kMinArea) return "has an area below " + in_metres(kMinArea * metre * metre) + "²";
  return std::nullopt;
}

Polygon centred(const Polygon& shape) {
  const Vector2d c = moments(shape).centroid;
  Polygon out = shape;
  for (Vector2d& v : out.vertices) v -= c;
  return out;
}

double bounding_radius(const Polygon& shape) {
  double r = 0.0;
  for (const Vector2d& v : shape.vertices) r = std::max(r, v.norm());
  return r;
}

Vector2d edge_normal(const Polygon& polygon, std::size_t k) {
  const Vector2d edge = polygon.vertices[(k + 1) % polygon.size()] - polygon.vertices[k];
  return Vector2d(edge.y(), -edge.x()).normalized();
}

Polygon box(double width, double height) {
  const double a = width / 2.0, b = height / 2.0;
  return {{{-a, -b}, {a, -b}, {a, b}, {-a, b}}};
}

Polygon regular_polygon(int sides, double circumradius) {
  Polygon shape;
  for (int k = 0; k < sides; ++k)
    shape.vertices.emplace_back(circumradius * unit(2.0 * std::numbers::pi * k / sides));
  return shape;
}

Polygon offset_polygon(const Polygon& polygon, double by) {
  const std::size_t count = polygon.size();
  std::vector<Vector2d> normals;  // outward; entry k is that of the edge that begins at vertex k
  for (std::size_t k = 0; k < count; ++k) normals.push_back(edge_normal(polygon, k));
  Polygon out;
  for (std::size_t k = 0; k < count; ++k) {
    const Vector2d &before = normals[(k + count - 1) % count], &after = normals[k];
    out.vertices.push_back(polygon.vertices[k] + by / (1.0 + before.dot(after)) * (before + after));
  }
  return out;
}

int symmetry_order(const Polygon& shape) {
  const double tolerance = 1e-6 * bounding_radius(shape);
  const std::size_t n = shape.size();
  for (std::size_t shift = 1; shift < n; ++shift)
    if (n % shift == 0 && maps_onto_itself(shape, shift, tolerance))
      return static_cast<int>(n / shift);
  return 1;
}

}  // namespace rtg

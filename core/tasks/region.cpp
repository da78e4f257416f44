#include "core/tasks/region.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/world/overlap.hpp"

namespace rtg::tasks {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr int kDiscSides = 96;

}  // namespace

double excess(const Region& region, const Vector2d& x) {
  if (const auto* disc = std::get_if<Disc>(&region))
    return (x - disc->centre).norm() - disc->radius;
  if (const auto* half = std::get_if<HalfPlane>(&region)) return half->normal.dot(x) - half->offset;
  const auto& polygon = std::get<Polygon>(region);
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < polygon.size(); ++k)
    most = std::max(most, edge_normal(polygon, k).dot(x - polygon.vertices[k]));
  return most;
}

Region inset(const Region& region, double by) {
  if (const auto* disc = std::get_if<Disc>(&region)) return Disc{disc->centre, disc->radius - by};
  if (const auto* half = std::get_if<HalfPlane>(&region))
    return HalfPlane{half->normal, half->offset - by};
  const auto& polygon = std::get<Polygon>(region);
  return by > 0.0 ? Polygon{inset_ring(polygon.vertices, by)} : offset_polygon(polygon, -by);
}

double half_width(const Region& region) {
  if (const auto* disc = std::get_if<Disc>(&region)) return disc->radius;
  if (std::holds_alternative<HalfPlane>(region)) return std::numeric_limits<double>::infinity();
  const auto& polygon = std::get<Polygon>(region);
  return -excess(region, moments(polygon).centroid);
}

Vector2d moved_into(const Region& region, const Vector2d& x, Rng& rng) {
  if (const auto* disc = std::get_if<Disc>(&region)) {
    const double r = disc->radius * std::sqrt(rng.uniform(0.0, 1.0));
    return disc->centre + r * unit(rng.uniform(0.0, kTwoPi));
  }
  if (const auto* half = std::get_if<HalfPlane>(&region)) {
    const double depth = half->offset - half->normal.dot(x);
    return x + (depth - rng.uniform(0.0, 1.0) * std::abs(depth)) * half->normal;
  }
  const std::vector<Vector2d>& ring = std::get<Polygon>(region).vertices;
  std::vector<double> areas;  // of the fan of triangles at vertex 0, summed
  for (std::size_t k = 1; k + 1 < ring.size(); ++k) {
    const Vector2d a = ring[k] - ring[0], b = ring[k + 1] - ring[0];
    areas.push_back((areas.empty() ? 0.0 : areas.back()) + a.x() * b.y() - a.y() * b.x());
  }
  const double drawn = rng.uniform(0.0, areas.back());
  const auto k = static_cast<std::size_t>(std::ranges::lower_bound(areas, drawn) - areas.begin());
  double s = rng.uniform(0.0, 1.0), t = rng.uniform(0.0, 1.0);
  if (s + t > 1.0) {
    s = 1.0 - s;
    t = 1.0 - t;
  }
  return ring[0] + s * (ring[k + 1] - ring[0]) + t * (ring[k + 2] - ring[0]);
}

bool meets_square(const Region& region, double a) {
  if (const auto* half = std::get_if<HalfPlane>(&region))
    return -a * half->normal.lpNorm<1>() <= half->offset;
  if (const auto* disc = std::get_if<Disc>(&region))
    return excess(region, disc->centre.cwiseMax(-a).cwiseMin(a)) <= 0.0;
  Vector2d low = Vector2d::Constant(INFINITY), high = -low;
  for (const Vector2d& v : std::get<Polygon>(region).vertices) {
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  return low.maxCoeff() <= a && high.minCoeff() >= -a;
}

std::vector<Vector2d> ring_of(const Region& region, double far) {
  if (const auto* polygon = std::get_if<Polygon>(&region)) return polygon->vertices;
  if (const auto* half = std::get_if<HalfPlane>(&region)) {
    const Vector2d along = far * Vector2d(-half->normal.y(), half->normal.x());
    const Vector2d edge = half->offset * half->normal, back = edge - 2.0 * far * half->normal;
    return {edge + along, back + along, back - along, edge - along};
  }
  const auto& disc = std::get<Disc>(region);
  std::vector<Vector2d> ring;
  for (int k = 0; k < kDiscSides; ++k)
    ring.push_back(disc.centre + disc.radius * unit(kTwoPi * k / kDiscSides));
  return ring;
}

}  // namespace rtg::tasks

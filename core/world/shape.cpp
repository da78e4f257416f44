#include "core/world/shape.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/world/outline.hpp"
#include "core/world/separation.hpp"

namespace rtg {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr double kSame = 1e-6;  // distance at which points count as one / bounding radius

/// Returns the integrals over the sector of a disc around `apex`, from the direction `from` over
/// the angle `turn`.
AreaIntegrals sector(const Vector2d& apex, double radius, double from, double turn) {
  const double area = radius * radius * turn / 2.0, to = from + turn;
  const Turn<double> begin = turn_of(from), end = turn_of(to);
  const double square = radius * radius;
  const Vector2d lever = square * radius / 3.0 * Vector2d(end.s - begin.s, begin.c - end.c);
  return {area, area * apex + lever,
          area * apex.squaredNorm() + 2.0 * apex.dot(lever) + square * square * turn / 4.0};
}

double angle_of(const Vector2d& v) { return rtg::angle_of(v.x(), v.y()); }

/// Returns `angle` plus the multiple of 2π that puts it into [0, 2π).
double positive(double angle) {
  const double turn = std::remainder(angle, kTwoPi);
  return turn < 0.0 ? turn + kTwoPi : turn;
}

Moments part_moments(const Part& part) {
  if (part.is_disc()) return sector(part.core.vertices[0], part.radius, 0.0, kTwoPi).moments();
  AreaIntegrals sum = area_integrals(part.core.vertices);
  const std::size_t count = part.core.size();
  for (std::size_t k = 0; k < count && part.radius > 0.0; ++k) {
    const Vector2d &v = part.core.vertices[k], &w = part.core.vertices[(k + 1) % count];
    const Vector2d normal = edge_normal(part.core, k), out = part.radius * normal;
    const Vector2d before = edge_normal(part.core, (k + count - 1) % count);
    sum.add(area_integrals(std::vector<Vector2d>{v, v + out, w + out, w}));
    sum.add(
        sector(v, part.radius, angle_of(before), positive(angle_of(normal) - angle_of(before))));
  }
  return sum.moments();
}

/// Returns the distance of a point from a core; negative inside, where it is that of the nearest
/// edge line.
double core_distance(const Polygon& core, const Vector2d& x) {
  double top = -INFINITY, least = INFINITY;
  for (std::size_t k = 0; k < core.size(); ++k) {
    const Vector2d &v = core.vertices[k], &w = core.vertices[(k + 1) % core.size()];
    least = std::min(least, distance_to_segment(x, v, w));
    if (core.size() > 1) top = std::max(top, edge_normal(core, k).dot(x - v));
  }
  return core.size() > 1 && top < 0.0 ? top : least;
}

/// An interval of directions: from `from` counter-clockwise over `turn` [rad].
struct Cone {
  double from = 0.0, turn = 0.0;
};

/// Returns the directions in which a sharp part extends from a point of it. `same` is the distance
/// below which points count as one.
Cone cone_at(const Polygon& core, const Vector2d& x, double same) {
  const std::size_t count = core.size();
  for (std::size_t k = 0; k < count; ++k)
    if ((core.vertices[k] - x).norm() <= same) {
      const Vector2d to = core.vertices[(k + 1) % count] - core.vertices[k];
      const Vector2d back = core.vertices[(k + count - 1) % count] - core.vertices[k];
      return {angle_of(to), positive(angle_of(back) - angle_of(to))};
    }
  for (std::size_t k = 0; k < count; ++k)
    if (std::abs(edge_normal(core, k).dot(x - core.vertices[k])) <= same)
      return {angle_of(core.vertices[(k + 1) % count] - core.vertices[k]), std::numbers::pi};
  return {0.0, kTwoPi};
}

/// Returns the largest angle that none of the cones covers [rad].
double largest_opening(std::vector<Cone> cones) {
  std::ranges::sort(cones, {}, [](const Cone& c) { return positive(c.from); });
  double opening = 0.0, end = positive(cones[0].from) + cones[0].turn;
  const double begin = positive(cones[0].from);
  for (const Cone& cone : cones) {
    opening = std::max(opening, positive(cone.from) - end);
    end = std::max(end, positive(cone.from) + cone.turn);
  }
  return std::max(opening, begin + kTwoPi - end);
}

/// Returns whether the corner at vertex `v` of part `n` can touch other bodies.
bool is_tip(std::span<const Part> parts, std::size_t n, std::size_t v, double same) {
  const Vector2d& x = parts[n].core.vertices[v];
  std::vector<Cone> cones;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const double inside = parts[k].radius - parts[n].radius - core_distance(parts[k].core, x);
    if (k == n || inside < -same) continue;
    if (inside > same) return false;  // the round corner lies in another part
    if (parts[n].radius > 0.0 || parts[k].radius > 0.0) {
      if (k < n) return false;  // its surface coincides with that of another part
      continue;
    }
    if (k < n)
      for (const Vector2d& w : parts[k].core.vertices)
        if ((w - x).norm() <= same) return false;  // a tip of the part before
    cones.push_back(cone_at(parts[k].core, x, same));
  }
  if (cones.empty()) return true;
  cones.push_back(cone_at(parts[n].core, x, same));
  return largest_opening(std::move(cones)) > std::numbers::pi + 1e-3;
}

/// Returns the number of points of a union that are farthest from the origin; 0 if they are a whole
/// circle, which then is the outline. Any symmetry maps them onto each other.
std::size_t farthest_points(std::span<const Part> parts) {
  double reach = 0.0;
  for (const Part& part : parts) reach = std::max(reach, reach_from(Vector2d::Zero(), part));
  std::vector<Vector2d> points;
  for (const Part& part : parts)
    for (const Vector2d& v : part.core.vertices) {
      if (v.norm() + part.radius < (1.0 - kSame) * reach) continue;
      if (v.norm() < kSame * reach) return 0;
      const Vector2d point = reach * v.normalized();
      const auto is_same = [&](const Vector2d& p) { return (p - point).norm() < 1e-3 * reach; };
      if (std::ranges::none_of(points, is_same)) points.push_back(point);
    }
  return points.size();
}

double symmetry_of(const std::vector<Part>& parts) {
  if (parts.size() == 1) return parts[0].is_disc() ? 0.0 : kTwoPi / symmetry_order(parts[0].core);
  std::size_t most = 0;
  for (const Part& part : parts) most += part.core.size();
  const std::size_t farthest = farthest_points(parts);
  if (farthest == 0) return 0.0;
  for (std::size_t order = most; order > 1; --order)
    if (farthest % order == 0 && maps_onto_itself(parts, kTwoPi / static_cast<double>(order)))
      return kTwoPi / static_cast<double>(order);
  return kTwoPi;
}

}  // namespace

double reach_from(const Vector2d& point, const Part& part) {
  double reach = 0.0;
  for (const Vector2d& v : part.core.vertices) reach = std::max(reach, (v - point).norm());
  return reach + part.radius;
}

Part disc(double radius) { return {{{Vector2d::Zero()}}, radius}; }

Shape::Shape(Polygon polygon) : Shape(Part{std::move(polygon), 0.0}) {}
Shape::Shape(Part part) : Shape(std::vector<Part>{std::move(part)}) {}

Shape::Shape(std::vector<Part> parts)
    : parts_(std::move(parts)),
      moments_(parts_.size() == 1 ? part_moments(parts_[0]) : union_moments(parts_)),
      symmetry_(symmetry_of(parts_)),
      pieces_(disjoint_pieces(parts_)) {
  for (const Part& part : parts_) radius_ = std::max(radius_, reach_from(Vector2d::Zero(), part));
  for (std::size_t n = 0; n < parts_.size(); ++n) {
    tips_.emplace_back();
    for (std::size_t v = 0; v < parts_[n].core.size(); ++v)
      if (is_tip(parts_, n, v, kSame * radius_)) tips_.back().push_back(v);
  }
}

std::vector<Part> placed(std::vector<Part> parts, double angle, const Vector2d& by) {
  for (Part& part : parts)
    for (Vector2d& v : part.core.vertices) v = rotate(angle, v) + by;
  return parts;
}

Shape Shape::centred() const { return Shape(placed(parts_, 0.0, -moments_.centroid)); }

}  // namespace rtg

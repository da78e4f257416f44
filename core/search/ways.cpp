#include "core/search/ways.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace rtg::search {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kBeyond = 1e-3;  // distance of corners from the obstacle [m]
constexpr double kGraze = 1e-6;   // depth up to which any way may enter an obstacle [m]
constexpr int kDiscSides = 8;     // of the polygon around a widened disc
constexpr int kDirections = 90;   // in which a width is measured

/// Returns a convex polygon around `part` at `pose`, widened by `by`.
Polygon widened(const Part& part, const Pose& pose, double by) {
  Polygon out = part.is_disc()
                    ? regular_polygon(kDiscSides,
                                      (part.radius + by) / turn_of(std::numbers::pi / kDiscSides).c)
                    : offset_polygon(part.core, part.radius + by);
  for (Vector2d& v : out.vertices)
    v = to_world(pose, part.is_disc() ? Vector2d(v + part.core.vertices[0]) : v);
  return out;
}

/// Returns how deep x lies in the polygon, the distance from its nearest line [m]; negative
/// outside.
double depth(const Polygon& polygon, const Vector2d& x) {
  double least = kInfinity;
  for (std::size_t k = 0; k < polygon.size(); ++k)
    least = std::min(least, edge_normal(polygon, k).dot(polygon.vertices[k] - x));
  return least;
}

/// Returns whether a point of the segment from a to b lies deeper than `free` [m] in the polygon,
/// by the clipping of [Cyrus and Beck 1978].
bool enters(const Polygon& polygon, const Vector2d& a, const Vector2d& b, double free) {
  double first = 0.0, last = 1.0;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vector2d &v = polygon.vertices[k], normal = edge_normal(polygon, k);
    const double from = normal.dot(a - v) + free, to = normal.dot(b - v) + free;
    if (from >= 0.0 && to >= 0.0) return false;
    const double at = from / (from - to);
    if (from > 0.0) first = std::max(first, at);
    if (to > 0.0) last = std::min(last, at);
  }
  return first < last;
}

}  // namespace

Ways::Ways(const Scene& scene, const Poses& poses, const std::vector<std::size_t>& obstacles,
           double clearance, double arena)
    : arena_(arena) {
  std::vector<Vector2d> found;
  for (const std::size_t i : obstacles) {
    for (const Part& part : scene.bodies[i].shape.parts()) {
      obstacles_.push_back(widened(part, poses[i], clearance));
      const Polygon around = widened(part, poses[i], clearance + kBeyond);
      found.insert(found.end(), around.vertices.begin(), around.vertices.end());
    }
  }
  for (const Vector2d& x : found)
    if (x.cwiseAbs().maxCoeff() <= arena &&
        std::ranges::none_of(obstacles_, [&](const Polygon& o) { return depth(o, x) > 0.0; }))
      corners_.push_back(x);
  const auto count = static_cast<Eigen::Index>(corners_.size());
  lengths_ = MatrixXd::Constant(count, count, kInfinity);
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index j = 0; j < count; ++j) {
      const Vector2d &a = corners_[static_cast<std::size_t>(i)],
                     &b = corners_[static_cast<std::size_t>(j)];
      if (i == j || is_free(a, b)) lengths_(i, j) = (a - b).norm();
    }
  for (Eigen::Index k = 0; k < count; ++k)  // [Floyd 1962]
    for (Eigen::Index i = 0; i < count; ++i)
      for (Eigen::Index j = 0; j < count; ++j)
        lengths_(i, j) = std::min(lengths_(i, j), lengths_(i, k) + lengths_(k, j));
}

/// A way enters an obstacle no deeper than its ends lie in it.
bool Ways::is_free(const Vector2d& a, const Vector2d& b) const {
  return std::ranges::none_of(obstacles_, [&](const Polygon& o) {
    return enters(o, a, b, std::max({0.0, depth(o, a), depth(o, b)}) + kGraze);
  });
}

/// Returns the corners that x sees, with their distances.
std::vector<std::pair<std::size_t, double>> Ways::seen_from(const Vector2d& x) const {
  std::vector<std::pair<std::size_t, double>> seen;
  for (std::size_t k = 0; k < corners_.size(); ++k)
    if (is_free(x, corners_[k])) seen.emplace_back(k, (x - corners_[k]).norm());
  return seen;
}

Ways::Way Ways::between(const Vector2d& a, const Vector2d& b) const {
  Way best{(a - b).norm(), b};
  if (obstacles_.empty() || is_free(a, b)) return best;
  const Way none{best.length + 2.0 * arena_, b};
  best.length = kInfinity;
  const auto ends = seen_from(b);
  for (const auto& [from, before] : seen_from(a))
    for (const auto& [to, after] : ends) {
      const double length =
          before + after + lengths_(static_cast<Eigen::Index>(from), static_cast<Eigen::Index>(to));
      if (length < best.length) best = {length, corners_[from]};
    }
  return std::isfinite(best.length) ? best : none;
}

double least_half_width(const Shape& shape) {
  double least = kInfinity;
  for (int k = 0; k < kDirections; ++k) {
    const Vector2d along = unit(std::numbers::pi * k / kDirections);
    double low = kInfinity, high = -kInfinity;
    for (const auto& [core, radius] : shape.parts())
      for (const Vector2d& v : core.vertices) {
        low = std::min(low, along.dot(v) - radius);
        high = std::max(high, along.dot(v) + radius);
      }
    least = std::min(least, (high - low) / 2.0);
  }
  return least;
}

}  // namespace rtg::search

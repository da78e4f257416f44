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

}  // namespace

Ways::Ways(const Scene& scene, const Poses& poses, const std::vector<std::size_t>& obstacles,
           double clearance, double arena)
    : arena_(arena) {
  std::vector<Vector2d> found;
  for (const std::size_t i : obstacles) {
    for (const Part& part : scene.bodies[i].shape.parts()) {
      const Polygon outline = widened(part, poses[i], clearance);
      obstacles_.push_back({outline.vertices, {}});
      for (std::size_t k = 0; k < outline.size(); ++k)
        obstacles_.back().normals.push_back(edge_normal(outline, k));
      const Polygon around = widened(part, poses[i], clearance + kBeyond);
      found.insert(found.end(), around.vertices.begin(), around.vertices.end());
    }
  }
  for (const Vector2d& x : found)
    if (x.cwiseAbs().maxCoeff() <= arena &&
        std::ranges::none_of(obstacles_, [&](const Obstacle& o) { return depth(o, x) > 0.0; }))
      corners_.push_back(point(x));
  const auto count = static_cast<Eigen::Index>(corners_.size());
  lengths_ = MatrixXd::Constant(count, count, kInfinity);
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index j = 0; j < count; ++j) {
      const Point &a = corners_[static_cast<std::size_t>(i)],
                  &b = corners_[static_cast<std::size_t>(j)];
      if (i == j || is_free(a, b)) lengths_(i, j) = (a.x - b.x).norm();
    }
  for (Eigen::Index k = 0; k < count; ++k)  // [Floyd 1962]
    for (Eigen::Index i = 0; i < count; ++i)
      for (Eigen::Index j = 0; j < count; ++j)
        lengths_(i, j) = std::min(lengths_(i, j), lengths_(i, k) + lengths_(k, j));
}

/// Returns how deep x lies in the obstacle, the distance from its nearest line [m]; negative
/// outside.
double Ways::depth(const Obstacle& obstacle, const Vector2d& x) {
  double least = kInfinity;
  for (std::size_t k = 0; k < obstacle.vertices.size(); ++k)
    least = std::min(least, obstacle.normals[k].dot(obstacle.vertices[k] - x));
  return least;
}

/// Returns whether a point of the segment from a to b lies deeper than `free` [m] in the obstacle,
/// by the clipping of [Cyrus and Beck 1978].
bool Ways::enters(const Obstacle& obstacle, const Vector2d& a, const Vector2d& b, double free) {
  double first = 0.0, last = 1.0;
  for (std::size_t k = 0; k < obstacle.vertices.size(); ++k) {
    const Vector2d &v = obstacle.vertices[k], &normal = obstacle.normals[k];
    const double from = normal.dot(a - v) + free, to = normal.dot(b - v) + free;
    if (from >= 0.0 && to >= 0.0) return false;
    const double at = from / (from - to);
    if (from > 0.0) first = std::max(first, at);
    if (to > 0.0) last = std::min(last, at);
  }
  return first < last;
}

Ways::Point Ways::point(const Vector2d& x) const {
  Point out{x, {}};
  out.depths.reserve(obstacles_.size());
  for (const Obstacle& o : obstacles_) out.depths.push_back(std::max(0.0, depth(o, x)));
  return out;
}

/// A way enters an obstacle no deeper than its ends lie in it.
bool Ways::is_free(const Point& a, const Point& b) const {
  for (std::size_t k = 0; k < obstacles_.size(); ++k)
    if (enters(obstacles_[k], a.x, b.x, std::max(a.depths[k], b.depths[k]) + kGraze)) return false;
  return true;
}

/// Returns the corners that a point sees, with their distances.
std::vector<std::pair<std::size_t, double>> Ways::seen_from(const Point& point) const {
  std::vector<std::pair<std::size_t, double>> seen;
  for (std::size_t k = 0; k < corners_.size(); ++k)
    if (is_free(point, corners_[k])) seen.emplace_back(k, (point.x - corners_[k].x).norm());
  return seen;
}

Ways::Way Ways::between(const Vector2d& a, const Vector2d& b) const {
  Way best{(a - b).norm(), b};
  if (obstacles_.empty()) return best;
  const Point start = point(a), end = point(b);
  if (is_free(start, end)) return best;
  const Way none{best.length + 2.0 * arena_, b};
  best.length = kInfinity;
  const auto ends = seen_from(end);
  for (const auto& [from, before] : seen_from(start))
    for (const auto& [to, after] : ends) {
      const double length =
          before + after + lengths_(static_cast<Eigen::Index>(from), static_cast<Eigen::Index>(to));
      if (length < best.length) best = {length, corners_[from].x};
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

#include "core/world/separation.hpp"

#include <algorithm>
#include <limits>

namespace rtg {
namespace {

/// Vertices as columns, at most 2 kMaxVertices. The area that a moving shape sweeps has more
/// vertices than the shape.
using Points = Eigen::Matrix<double, 2, Eigen::Dynamic, 0, 2, 2 * kMaxVertices>;

/// Returns the vertices of `b` in the frame of a body with the pose `pose_a`.
Points local_points(const Pose& pose_a, const Polygon& b, const Pose& pose_b) {
  const Vector2d offset = to_local(pose_a, pose_b.position());
  const auto [c, s] = turn_of(pose_b.theta - pose_a.theta);
  Points out(2, static_cast<Eigen::Index>(b.size()));
  for (std::size_t k = 0; k < b.size(); ++k) {
    const Vector2d& v = b.vertices[k];
    out.col(static_cast<Eigen::Index>(k)) << offset.x() + c * v.x() - s * v.y(),
        offset.y() + s * v.x() + c * v.y();
  }
  return out;
}

/// Returns the largest gap between an edge line of `a` and all vertices of `b`. May stop early and
/// return a smaller gap that is at least `enough`.
double one_sided(const Polygon& a, const Points& points, double enough) {
  double best = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; a.size() > 1 && k < a.size() && best < enough; ++k) {
    const Vector2d& v = a.vertices[k];
    const Vector2d edge = a.vertices[(k + 1) % a.size()] - v;
    const Vector2d normal = Vector2d(edge.y(), -edge.x()).normalized();
    double gap = std::numeric_limits<double>::infinity();
    for (Eigen::Index w = 0; w < points.cols(); ++w)
      gap = std::min(gap, normal.dot(points.col(w) - v));
    best = std::max(best, gap);
  }
  return best;
}

/// Returns the least distance of a point from an edge of `a`, or from its only vertex.
double edge_distance(const Polygon& a, const Points& points) {
  double least = std::numeric_limits<double>::infinity();
  for (Eigen::Index w = 0; w < points.cols(); ++w)
    for (std::size_t k = 0; k < a.size(); ++k)
      least = std::min(
          least, distance_to_segment(points.col(w), a.vertices[k], a.vertices[(k + 1) % a.size()]));
  return least;
}

/// Returns separation(). May stop early and return less if that is at least `enough`.
double separation_up_to(const Part& a, const Pose& pose_a, const Part& b, const Pose& pose_b,
                        double enough) {
  const double radii = a.radius + b.radius;
  const Points b_in_a = local_points(pose_a, b.core, pose_b);
  double apart = one_sided(a.core, b_in_a, enough + radii);
  if (apart - radii >= enough) return apart - radii;
  const Points a_in_b = local_points(pose_b, a.core, pose_a);
  apart = std::max(apart, one_sided(b.core, a_in_b, enough + radii));
  if (radii == 0.0 || apart - radii >= enough) return apart - radii;
  const bool points = a.is_disc() && b.is_disc();
  if (apart < 0.0 && !points) return apart - radii;
  return std::min(edge_distance(a.core, b_in_a), edge_distance(b.core, a_in_b)) - radii;
}

}  // namespace

double separation(const Part& a, const Pose& pose_a, const Part& b, const Pose& pose_b) {
  return separation_up_to(a, pose_a, b, pose_b, INFINITY);
}

double separation(std::span<const Part> a, const Pose& pose_a, std::span<const Part> b,
                  const Pose& pose_b) {
  double least = std::numeric_limits<double>::infinity();
  for (const Part& one : a)
    for (const Part& other : b) least = std::min(least, separation(one, pose_a, other, pose_b));
  return least;
}

bool are_apart(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
               double margin) {
  return std::ranges::all_of(a.parts(), [&](const Part& one) {
    return std::ranges::all_of(b.parts(), [&](const Part& other) {
      return separation_up_to(one, pose_a, other, pose_b, margin) >= margin;
    });
  });
}

double distance_to_segment(const Vector2d& x, const Vector2d& a, const Vector2d& b) {
  const Vector2d path = b - a;
  const double along = path.dot(x - a) / std::max(path.squaredNorm(), 1e-12);
  return (x - a - std::clamp(along, 0.0, 1.0) * path).norm();
}

std::optional<std::pair<std::size_t, std::size_t>> first_overlap(const Scene& scene,
                                                                 const Poses& poses,
                                                                 double margin) {
  for (std::size_t i = 0; i < scene.size(); ++i)
    for (std::size_t j = i + 1; j < scene.size(); ++j) {
      const Body &a = scene.bodies[i], &b = scene.bodies[j];
      if ((a.fixed && b.fixed) || jointed(scene, i, j)) continue;
      const double reach = a.shape.radius() + b.shape.radius() + margin;
      if ((poses[i].position() - poses[j].position()).norm() > reach) continue;
      if (!are_apart(a.shape, poses[i], b.shape, poses[j], margin)) return {{i, j}};
    }
  return std::nullopt;
}

}  // namespace rtg

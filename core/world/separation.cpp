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
  const double c = std::cos(pose_b.theta - pose_a.theta), s = std::sin(pose_b.theta - pose_a.theta);
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
double one_sided(const Polygon& a, const Pose& pose_a, const Polygon& b, const Pose& pose_b,
                 double enough = INFINITY) {
  const Points points = local_points(pose_a, b, pose_b);
  double best = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < a.size() && best < enough; ++k) {
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

}  // namespace

double separation(const Polygon& a, const Pose& pose_a, const Polygon& b, const Pose& pose_b) {
  return std::max(one_sided(a, pose_a, b, pose_b), one_sided(b, pose_b, a, pose_a));
}

bool are_apart(const Polygon& a, const Pose& pose_a, const Polygon& b, const Pose& pose_b,
               double margin) {
  return one_sided(a, pose_a, b, pose_b, margin) >= margin ||
         one_sided(b, pose_b, a, pose_a, margin) >= margin;
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
      const double reach = bounding_radius(a.shape) + bounding_radius(b.shape) + margin;
      if ((poses[i].position() - poses[j].position()).norm() > reach) continue;
      if (!are_apart(a.shape, poses[i], b.shape, poses[j], margin)) return {{i, j}};
    }
  return std::nullopt;
}

}  // namespace rtg

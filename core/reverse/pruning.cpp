#include "core/reverse/pruning.hpp"

#include <algorithm>

#include "core/world/separation.hpp"

namespace rtg::reverse {
namespace {

constexpr double kOverlap = 0.01;  // largest overlap of sweep and body that counts as touching [m]
// Largest allowed overlap of the robot's sweep and a movable body with a joint [m]. The body may
// have swung in behind the robot: by up to 0.71 in 24,000 pushes that moved ArtManip's chain.
constexpr double kSwing = 0.75;
constexpr double kClearance = 0.1;  // added to the range, as objects turn on their way [m]

double cross(const Vector2d& o, const Vector2d& a, const Vector2d& b) {
  return (a.x() - o.x()) * (b.y() - o.y()) - (a.y() - o.y()) * (b.x() - o.x());
}

/// Returns the counter-clockwise convex hull [Andrew 1979].
std::vector<Vector2d> convex_hull(std::vector<Vector2d> points) {
  std::sort(points.begin(), points.end(), [](const Vector2d& a, const Vector2d& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  std::vector<Vector2d> hull;
  const auto extend = [&hull](const Vector2d& point, std::size_t kept) {
    while (hull.size() > kept && cross(hull[hull.size() - 2], hull.back(), point) <= 1e-12)
      hull.pop_back();
    hull.push_back(point);
  };
  for (const Vector2d& point : points) extend(point, 1);
  const std::size_t lower = hull.size();
  for (auto point = points.rbegin() + 1; point != points.rend(); ++point) extend(*point, lower);
  hull.pop_back();
  return hull;
}

}  // namespace

std::vector<Part> swept(const Shape& shape, double theta, const Vector2d& by) {
  std::vector<Part> out;
  for (const Part& part : shape.parts()) {
    std::vector<Vector2d> points = part.core.vertices;
    for (const Vector2d& v : part.core.vertices) points.push_back(v + rotate(-theta, by));
    out.push_back({{convex_hull(std::move(points))}, part.radius});
  }
  return out;
}

bool is_pruned(const Scene& scene, const PushConfig& push, const ReverseJob& job) {
  const Pose& robot = job.end[0];
  const Vector2d back = -stride_of(job.action, push) * direction(job.action, push);
  if (!in_arena({robot.x + back.x(), robot.y + back.y(), robot.theta}, push)) return true;
  const Shape& shape = scene.bodies[0].shape;
  const std::vector<Part> way = swept(shape, robot.theta, back);
  for (std::size_t k = 1; k < scene.size(); ++k) {
    const Shape& other = scene.bodies[k].shape;
    const Vector2d from = robot.position();
    if (distance_to_segment(job.end[k].position(), from, from + back) >
        shape.radius() + other.radius())
      continue;
    const double touching = std::min(0.0, separation(shape, robot, other, job.end[k]));
    const bool swings = has_joint(scene, k) && !scene.bodies[k].fixed;
    const double allowed = swings ? kSwing : kOverlap;
    if (separation(way, robot, other.parts(), job.end[k]) < touching - allowed) return true;
  }
  return false;
}

std::vector<int> relevant_bodies(const Scene& scene, const PushConfig& push, const ReverseJob& job,
                                 double range) {
  const Vector2d back = -stride_of(job.action, push) * direction(job.action, push);
  std::vector<int> found{0};
  std::vector<bool> seen(scene.size(), false);
  seen[0] = true;
  for (std::size_t n = 0; n < found.size(); ++n) {
    const auto i = static_cast<std::size_t>(found[n]);
    if (scene.bodies[i].fixed) continue;
    const std::vector<Part> way = swept(scene.bodies[i].shape, job.end[i].theta, back);
    double reach = i == 0 ? range : range + kClearance;
    if (has_joint(scene, i)) reach += stride_of(job.action, push);  // links also swing
    for (std::size_t k = 1; k < scene.size(); ++k) {
      if (seen[k]) continue;
      if (!jointed(scene, i, k) &&
          separation(way, job.end[i], scene.bodies[k].shape.parts(), job.end[k]) >= reach)
        continue;
      seen[k] = true;
      found.push_back(static_cast<int>(k));
    }
  }
  std::sort(found.begin(), found.end());
  std::stable_partition(found.begin(), found.end(), [&scene](int k) {
    return !scene.bodies[static_cast<std::size_t>(k)].fixed;
  });
  return found;
}

}  // namespace rtg::reverse

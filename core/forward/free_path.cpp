#include "core/forward/free_path.hpp"

#include <algorithm>
#include <cmath>

#include "core/world/separation.hpp"

namespace rtg::forward {
namespace {

constexpr double kNear = 0.05;         // least gap between the robot and other bodies [m]
constexpr double kNearEnough = 0.055;  // the search ends here: strides vanish towards kNear [m]

}  // namespace

/// Conservative advancement: each stride is the longest that the separation from the body permits.
double free_path_length(const Scene& scene, const Poses& poses, const Pose& to) {
  const Vector2d from = poses[0].position();
  const double length = (to.position() - from).norm();
  const Shape& robot = scene.bodies[0].shape;
  const double radius = robot.radius() + kNear;
  double clear = length;
  for (std::size_t j = 1; j < scene.size(); ++j) {
    const Shape& shape = scene.bodies[j].shape;
    if (distance_to_segment(poses[j].position(), from, to.position()) > radius + shape.radius())
      continue;
    double travelled = 0.0;
    for (double gap = INFINITY; travelled < clear && gap > kNearEnough;
         travelled += std::max(gap - kNear, 0.0)) {
      Pose at = poses[0];
      at.x += travelled / length * (to.x - from.x());
      at.y += travelled / length * (to.y - from.y());
      gap = separation(robot, at, shape, poses[j]);
    }
    clear = std::min(clear, travelled);
  }
  return clear;
}

}  // namespace rtg::forward

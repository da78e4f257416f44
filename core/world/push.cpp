#include "core/world/push.hpp"

#include <algorithm>
#include <numbers>

namespace rtg {

Vector2d direction(int action, const PushConfig& config) {
  const double angle = 2.0 * std::numbers::pi * action / config.headings;
  return {std::cos(angle), std::sin(angle)};
}

Pose push_target(const Pose& robot, int action, const PushConfig& config) {
  const Vector2d to = robot.position() + config.stride * direction(action, config);
  return {std::clamp(to.x(), -config.arena, config.arena),
          std::clamp(to.y(), -config.arena, config.arena), robot.theta};
}

bool in_arena(const Pose& robot, const PushConfig& config) {
  return std::abs(robot.x) <= config.arena && std::abs(robot.y) <= config.arena;
}

}  // namespace rtg

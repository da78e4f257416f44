#include "core/world/push.hpp"

#include <algorithm>
#include <numbers>

namespace rtg {

int action_count(const PushConfig& config) {
  return config.headings * static_cast<int>(config.strides.size());
}

int stride_index(int action, const PushConfig& config) { return action / config.headings; }

double stride_of(int action, const PushConfig& config) {
  return config.strides[static_cast<std::size_t>(stride_index(action, config))];
}

double longest_stride(const PushConfig& config) { return std::ranges::max(config.strides); }

PushConfig with_stride_of(int action, const PushConfig& config) {
  PushConfig one = config;
  one.strides = {stride_of(action, config)};
  return one;
}

Vector2d direction(int action, const PushConfig& config) {
  return unit(2.0 * std::numbers::pi * (action % config.headings) / config.headings);
}

Stroke stroke_of(int action, const PushConfig& config) {
  return {direction(action, config), stride_of(action, config)};
}

Pose push_target(const Pose& robot, const Stroke& stroke, const PushConfig& config) {
  const Vector2d to = robot.position() + stroke.length * stroke.direction;
  return {std::clamp(to.x(), -config.arena, config.arena),
          std::clamp(to.y(), -config.arena, config.arena), robot.theta};
}

bool in_arena(const Pose& robot, const PushConfig& config) {
  return std::abs(robot.x) <= config.arena && std::abs(robot.y) <= config.arena;
}

}  // namespace rtg

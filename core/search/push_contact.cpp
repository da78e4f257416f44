#include "core/search/push_contact.hpp"

#include <algorithm>
#include <utility>

#include "core/reverse/pruning.hpp"
#include "core/world/separation.hpp"

namespace rtg {

PushContact::PushContact(Scene scene, PushConfig push, double heading)
    : scene_(std::move(scene)), push_(push), heading_(heading) {
  for (int action = 0; action < push.headings; ++action)
    ways_.push_back(swept(scene_.bodies[0].shape, heading, push.stride * direction(action, push)));
}

void PushContact::describe(const Poses& state, int action, std::span<float> out) const {
  std::fill(out.begin(), out.end(), 0.0F);
  const Vector2d ahead = direction(action, push_);
  const Polygon& way = ways_[static_cast<std::size_t>(action)];
  const Pose robot{state[0].x, state[0].y, heading_};
  const Vector2d target = robot.position() + push_.stride * ahead;
  const double radius = bounding_radius(scene_.bodies[0].shape);
  const std::size_t bodies = scene_.size() - 1;
  for (std::size_t k = 1; k <= bodies; ++k) {
    const Polygon& shape = scene_.bodies[k].shape;
    const Vector2d arm = state[k].position() - robot.position();
    if (distance_to_segment(state[k].position(), robot.position(), target) >
        radius + bounding_radius(shape))
      continue;
    const double cut = std::max(0.0, -separation(way, robot, shape, state[k]));
    out[k - 1] = static_cast<float>(cut);
    out[bodies + k - 1] = static_cast<float>(cut * (ahead.x() * arm.y() - ahead.y() * arm.x()));
  }
}

}  // namespace rtg

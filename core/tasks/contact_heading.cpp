#include "core/tasks/contact_heading.hpp"

#include <cmath>
#include <numbers>
#include <vector>

namespace rtg::tasks {
namespace {

/// Draws a random point within the bounding circle of a random movable object.
Vector2d aim(const Task& task, const Poses& state, Rng& rng) {
  std::vector<std::size_t> objects;
  for (std::size_t k = 1; k < state.size(); ++k)
    if (!task.scene.bodies[k].fixed) objects.push_back(k);
  const std::size_t k =
      objects[static_cast<std::size_t>(rng.below(static_cast<int>(objects.size())))];
  const double angle = rng.uniform(0.0, 2.0 * std::numbers::pi);
  const double radius = task.scene.bodies[k].shape.radius() * std::sqrt(rng.uniform(0.0, 1.0));
  return state[k].position() + radius * unit(angle);
}

}  // namespace

int contact_heading(const Task& task, const Poses& state, Rng& rng) {
  const int headings = task.push.headings;
  const Vector2d way = aim(task, state, rng) - state[0].position();
  const double turns = angle_of(way.x(), way.y()) / (2.0 * std::numbers::pi);
  const int nearest = static_cast<int>(std::lround(turns * headings));
  const int strides = static_cast<int>(task.push.strides.size());
  const int stride = strides > 1 ? rng.below(strides) : 0;
  return stride * headings + (nearest + headings) % headings;
}

}  // namespace rtg::tasks

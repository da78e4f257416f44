#pragma once

#include <optional>
#include <vector>

#include "core/tasks/task.hpp"

namespace rtg::tasks {

/// Distance that sample_goal() keeps between bodies [m]. For Box2D, bodies closer than 0.02 m are
/// in contact.
inline constexpr double kClearance = 0.0215;

/// Bodies placed so far: `poses[i]` is valid if `placed[i]`.
struct Layout {
  Poses poses;
  std::vector<bool> placed;
};

/// Returns whether body `i` at `pose` keeps kClearance from all placed bodies, except those that a
/// joint connects with it.
bool is_clear(const Task& task, const Layout& layout, std::size_t i, const Pose& pose);

/// A straight motion of a body towards the placed bodies.
struct Approach {
  Pose from;
  Vector2d heading;
  double gap = 0.0;    // left to the first placed body [m]
  double range = 0.0;  // greatest length of the motion [m]
};

/// Returns the pose of body `i` at the end of its approach, `gap` away from the first placed body;
/// nothing if it meets none within `range` or begins closer than `gap`.
std::optional<Pose> slide(const Task& task, const Layout& layout, std::size_t i,
                          const Approach& way);

}  // namespace rtg::tasks

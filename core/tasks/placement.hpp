#pragma once

#include <optional>
#include <vector>

#include "core/tasks/task.hpp"

namespace rtg::tasks {

/// The distance that sample_goal() keeps between bodies; closer than 0.02 they are in contact for
/// Box2D [m].
inline constexpr double kClearance = 0.0215;

/// Bodies placed so far: `placed[i]` says whether `poses[i]` counts.
struct Layout {
  Poses poses;
  std::vector<bool> placed;
};

/// Says whether body `i` at `pose` keeps kClearance from all placed bodies, but for what a joint
/// connects it with.
bool is_clear(const Task& task, const Layout& layout, std::size_t i, const Pose& pose);

/// A straight way of a body towards the placed ones.
struct Approach {
  Pose from;
  Vector2d heading;
  double gap = 0.0;    // left between them [m]
  double range = 0.0;  // its longest [m]
};

/// Where body `i` ends its approach, `gap` away from the first placed body; empty if it meets none
/// within `range`.
std::optional<Pose> slide(const Task& task, const Layout& layout, std::size_t i,
                          const Approach& way);

}  // namespace rtg::tasks

#pragma once

#include <optional>

#include "core/tasks/goal_draw.hpp"

namespace rtg::tasks {

/// Proposes a pose of body `i` beside a random other body. Returns nothing if that is not placed.
std::optional<Pose> beside_any(GoalDraw& draw, std::size_t i);

/// Proposes a pose of body `i` at one of the bodies that it is to touch, and of two if there are
/// more: beside the first it then moves along until it meets the second.
std::optional<Pose> in_touch(GoalDraw& draw, std::size_t i);

}  // namespace rtg::tasks

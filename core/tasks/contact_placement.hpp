#pragma once

#include <optional>

#include "core/tasks/goal_draw.hpp"

namespace rtg::tasks {

/// Proposes a pose of body `i` beside a random other body. Returns nothing if that is not placed.
std::optional<Pose> beside_any(GoalDraw& draw, std::size_t i);

/// Returns whether a term asks body `i` to touch others, or a placed body to touch body `i`.
bool is_to_touch(const GoalDraw& draw, std::size_t i);

/// Proposes a pose of body `i` at one of the bodies that it is to touch or that are to touch it,
/// and of two if there are more: beside the first it then moves along until it meets the second.
/// Returns nothing if none of them is placed.
std::optional<Pose> in_touch(GoalDraw& draw, std::size_t i);

}  // namespace rtg::tasks

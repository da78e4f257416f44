#pragma once

#include "core/tasks/goal_draw.hpp"

namespace rtg::tasks {

/// Places the robot, with its angle of `task.start`: just behind a body as after a push (3 of 4
/// draws), or near a body but clear of all. Returns whether one of kProposals tries succeeded.
bool place_robot(GoalDraw& draw);

}  // namespace rtg::tasks

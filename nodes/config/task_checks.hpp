#pragma once

#include "core/tasks/task.hpp"
#include "nodes/config/config_tree.hpp"

namespace rtg::config {

/// Throws ConfigError if two bodies of `task` have the same name. `section`: the section `task`,
/// for the place in the message.
void check_names(const tasks::Task& task, const ConfigNode& section);

/// Checks conditions on several values of the task. Throws ConfigError if no object can move, a
/// body of the start state overlaps another one or lies outside the arena, a goal term concerns no
/// movable object and no joint, the goal holds in the start state, or no layout that meets the goal
/// is found. `section`: the section `task`, for the place in the message.
void check_task(const tasks::Task& task, const ConfigNode& section);

}  // namespace rtg::config

#pragma once

#include "core/tasks/task.hpp"
#include "nodes/config/config_tree.hpp"

namespace rtg::config {

/// Throws ConfigError if two bodies of `task` have the same name. `section`: the section `task`,
/// for messages.
void check_names(const tasks::Task& task, const ConfigNode& section);

/// Checks values of the task that must fit together. `section`: the section `task`, for messages.
/// Throws ConfigError if
///
///  - no object can move, or the robot is fixed;
///  - a movable body starts outside the arena or is larger, or bodies overlap or touch;
///  - a goal term concerns no movable object and no joint, or no point of the arena;
///  - no legal angle of a joint meets a goal term, or a fixed body violates one;
///  - the goal holds in the start state, or no layout that meets it is found.
void check_task(const tasks::Task& task, const ConfigNode& section);

}  // namespace rtg::config

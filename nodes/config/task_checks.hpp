#pragma once

#include "core/tasks/task.hpp"
#include "nodes/config/config_tree.hpp"

namespace rtg::config {

/// Throws ConfigError if two bodies of `task` have the same name, or if a body is of kind robot but
/// the first is not. `section`: the section `task`, for messages.
void check_names(const tasks::Task& task, const ConfigNode& section);

/// Checks the goal terms, which needs no start state. `section`: the section `task`, for messages.
/// Throws ConfigError if
///
///  - no object can move, or the robot is fixed;
///  - a term concerns no movable object and no joint, or no point of the arena;
///  - a term compares an object with others of a kind that none has;
///  - no legal angle of a joint meets a term.
void check_terms(const tasks::Task& task, const ConfigNode& section);

/// Checks the rest of what must fit together. `section`: the section `task`, for messages. Throws
/// ConfigError if
///
///  - a movable body starts outside the arena or is larger, or bodies overlap or touch;
///  - a fixed body violates a goal term;
///  - the goal holds in the start state, or no layout that meets it is found.
void check_task(const tasks::Task& task, const ConfigNode& section);

}  // namespace rtg::config

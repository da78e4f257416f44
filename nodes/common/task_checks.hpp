#pragma once

#include "core/tasks/task.hpp"
#include "nodes/common/config_tree.hpp"

namespace rtg {

/// Throws ConfigError, at the place in `section` that it was read from, for a task that hangs
/// together in no way: names that differ not, a start state that overlaps or lies outside, a goal
/// that concerns nobody, holds from the start or that nothing can meet.
void check_task(const Task& task, const ConfigNode& section);

}  // namespace rtg

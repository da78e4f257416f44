#pragma once

#include "core/tasks/task.hpp"
#include "nodes/config/config_tree.hpp"

namespace rtg::config {

/// Throws ConfigError with the place in `section`, which the bodies of `task` were read from, for
/// two of the same name.
void check_names(const tasks::Task& task, const ConfigNode& section);

/// Checks what concerns several values at once. Throws ConfigError with the place in `section`,
/// which `task` was read from, for: nothing that can move, a start state that overlaps or lies
/// outside, a goal that concerns nobody, holds from the start or that no layout meets.
void check_task(const tasks::Task& task, const ConfigNode& section);

}  // namespace rtg::config

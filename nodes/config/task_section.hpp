#pragma once

#include "core/tasks/task.hpp"
#include "nodes/config/config_tree.hpp"

namespace rtg::config {

/// Returns the task that the section `task` describes. Throws ConfigError if the task is not legal:
/// shapes, names, overlaps, a goal that no layout meets. The vertices of a polygon may be given in
/// any frame with the body's orientation; start positions are those of the centroids.
tasks::Task read_task(const ConfigNode& section);

/// Returns the section from which read_task() reads `task`.
ConfigNode task_node(tasks::Task task);

}  // namespace rtg::config

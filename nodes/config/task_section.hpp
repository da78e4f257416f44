#pragma once

#include "core/tasks/task.hpp"
#include "nodes/config/config_tree.hpp"

namespace rtg::config {

/// Reads the section `task`. Throws ConfigError if the task is not legal: shapes, names, overlaps,
/// a goal that no layout meets. Vertices of a polygon may have any origin. The origin of the body
/// is its centroid, to which start positions refer.
tasks::Task read_task(const ConfigNode& section);

/// Converts `task` to a section, from which read_task() reads it back.
ConfigNode task_node(tasks::Task task);

}  // namespace rtg::config

#pragma once

#include "core/tasks/task.hpp"
#include "nodes/config/config_tree.hpp"

namespace rtg::config {

/// The task that the section `task` describes; throws ConfigError for anything that makes no legal
/// task: shapes, names, overlaps, a goal that nothing can meet. A polygon's vertices may be listed
/// in any frame; start states are of the centroid.
tasks::Task read_task(const ConfigNode& section);

/// The section that reads back to `task`.
ConfigNode task_node(tasks::Task task);

}  // namespace rtg::config

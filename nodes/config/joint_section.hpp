#pragma once

#include "core/tasks/task.hpp"
#include "nodes/config/config_tree.hpp"

namespace rtg::config {

/// Converts `section`, whose dotted key is `path`, to a joint between bodies of `task`. The value
/// of a prismatic joint is 0 in task.start. Throws ConfigError if it is not legal.
Joint read_joint(const ConfigNode& section, const std::string& path, const tasks::Task& task);

/// Converts a joint of `task` to a section, from which read_joint() reads it back.
ConfigNode joint_node(const Joint& joint, const tasks::Task& task);

/// Moves the children of all joints in task.start so that the joints close in single precision.
/// `section`: the section `task`, for messages. Throws ConfigError if
///
///  - the joints do not form trees, or a child is fixed;
///  - a joint in task.start is open by more than 1 mm, or its value is beyond its limits.
void close_joints(tasks::Task& task, const ConfigNode& section);

}  // namespace rtg::config

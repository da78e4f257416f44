#pragma once

#include "core/tasks/task.hpp"
#include "nodes/config/config_tree.hpp"

namespace rtg::config {

/// Returns the joint between bodies of `scene` that `section` describes. Throws ConfigError if it
/// describes none.
Joint read_joint(const ConfigNode& section, const std::string& path, const Scene& scene);

/// Returns the section from which read_joint() reads `joint`.
ConfigNode joint_node(const Joint& joint, const Scene& scene);

/// Moves every child of the start state to its pin, in single precision. Throws ConfigError if the
/// joints do not form trees, a child is fixed, or a joint of the start state is open by more than
/// 1 mm or has an angle beyond its limits. `section`: the section `task`.
void close_joints(tasks::Task& task, const ConfigNode& section);

}  // namespace rtg::config

#pragma once

#include "core/tasks/task.hpp"
#include "nodes/config/config_tree.hpp"

namespace rtg::config {

/// The joint that a section describes, between bodies of `scene`; throws ConfigError for what is
/// none.
Joint read_joint(const ConfigNode& section, const std::string& path, const Scene& scene);

/// The section that reads back to `joint`.
ConfigNode joint_node(const Joint& joint, const Scene& scene);

/// Moves every child of the start state to its pin, in single precision. Throws ConfigError where
/// joints make no trees, a child is fixed, the start state is more than 1 mm off a pin or an angle
/// beyond its limits. `section`: of the task.
void close_joints(tasks::Task& task, const ConfigNode& section);

}  // namespace rtg::config

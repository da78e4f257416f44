#pragma once

#include "core/tasks/goal.hpp"
#include "nodes/config/config_tree.hpp"

namespace rtg::config {

/// The term of a goal that a section describes; throws ConfigError for what is none.
tasks::GoalTerm read_term(const ConfigNode& section, const std::string& path);

/// The section that reads back to `term`.
ConfigNode term_node(const tasks::GoalTerm& term);

}  // namespace rtg::config

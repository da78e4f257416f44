#pragma once

#include "core/tasks/goal.hpp"
#include "nodes/config/config_tree.hpp"

namespace rtg::config {

/// Returns the goal term that `section` describes. Throws ConfigError if it describes none.
tasks::GoalTerm read_term(const ConfigNode& section, const std::string& path);

/// Returns the section from which read_term() reads `term`.
ConfigNode term_node(const tasks::GoalTerm& term);

}  // namespace rtg::config

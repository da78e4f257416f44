#pragma once

#include "core/tasks/goal.hpp"
#include "nodes/config/config_tree.hpp"

namespace rtg::config {

/// Converts `section`, whose dotted key is `path`, to a goal term. Throws ConfigError if it is not
/// legal.
tasks::GoalTerm read_term(const ConfigNode& section, const std::string& path);

/// Converts `term` to a section, from which read_term() reads it back.
ConfigNode term_node(const tasks::GoalTerm& term);

}  // namespace rtg::config

#pragma once

#include "core/tasks/goal.hpp"
#include "nodes/config/config_tree.hpp"

namespace rtg {

/// The term of a goal that a section describes; throws ConfigError for what is none.
GoalTerm read_term(const ConfigNode& section, const std::string& path);

/// The section that reads back to `term`.
ConfigNode term_node(const GoalTerm& term);

}  // namespace rtg

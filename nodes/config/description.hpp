#pragma once

#include <string>

#include "nodes/config/config.hpp"

namespace rtg::config {

/// Returns a description of the configuration for the user: bodies with sizes and masses, goal,
/// actions, episodes, and the work of the search and of the learner.
std::string description(const Config& config);

}  // namespace rtg::config

#pragma once

#include <string>

#include "nodes/config/config.hpp"

namespace rtg::config {

/// A configuration in words, for the person who wrote it: bodies with sizes and masses, the goal
/// in words, actions, episodes, the work of the search and of the learner.
std::string description(const Config& config);

}  // namespace rtg::config

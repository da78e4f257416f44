#pragma once

#include <string>
#include <vector>

#include "nodes/config/config.hpp"

namespace rtg::config {

/// Returns a description of the configuration for the user: bodies with sizes and masses, goal,
/// actions, episodes, and the work of the search and of the learner.
std::string description(const Config& config);

/// Returns in words which loose bodies are so heavy that the robot pushes them by less than half a
/// stride, and by how much: see paces().
std::vector<std::string> heavy_bodies(const Config& config);

}  // namespace rtg::config

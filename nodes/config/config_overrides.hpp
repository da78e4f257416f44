#pragma once

#include <string>

#include "nodes/config/config_tree.hpp"

namespace rtg::config {

/// Puts the value of `--set KEY=VALUE` in its place in the tree. KEY is dotted, entries of lists go
/// by their number from 0. What is on the way and missing is made, so that readers find fault with
/// a key that means nothing. Throws ConfigError.
void apply_override(ConfigNode& root, const std::string& setting);

}  // namespace rtg::config

#pragma once

#include <string>

#include "nodes/config/config_tree.hpp"

namespace rtg::config {

/// Applies a flag `--set KEY=VALUE` to the tree `root`; `setting` is "KEY=VALUE". KEY is a dotted
/// path that names list entries by number, from 0. Creates missing mappings and keys; unknown keys
/// are found when a section is read. Throws ConfigError for a `setting` that is not legal.
void apply_override(ConfigNode& root, const std::string& setting);

}  // namespace rtg::config

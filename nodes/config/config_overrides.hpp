#pragma once

#include <string>

#include "nodes/config/config_tree.hpp"

namespace rtg::config {

/// Sets the value of `setting`, "KEY=VALUE" of a flag `--set`, in the tree. KEY is a dotted path;
/// a list entry is selected by its number, counted from 0. Missing mappings and keys on the path
/// are created; the readers of the sections then report unknown keys. Throws ConfigError.
void apply_override(ConfigNode& root, const std::string& setting);

}  // namespace rtg::config

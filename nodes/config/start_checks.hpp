#pragma once

#include "nodes/config/config.hpp"
#include "nodes/config/config_tree.hpp"

namespace rtg::config {

/// Checks the random displacements of objects in starts, such as task.start_jitter. Throws
/// ConfigError if too few starts with such displacements are legal, see allows_jitter(). `root`:
/// the configuration tree, for the place in the message.
void check_jitters(const Config& config, const ConfigNode& root);

}  // namespace rtg::config

#pragma once

#include "nodes/config/config.hpp"
#include "nodes/config/config_tree.hpp"

namespace rtg::config {

/// Throws ConfigError, with the place in `root`, if objects cannot be moved about by one of the
/// jitters of `config`: see allows_jitter().
void check_jitters(const Config& config, const ConfigNode& root);

}  // namespace rtg::config

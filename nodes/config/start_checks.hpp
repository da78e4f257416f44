#pragma once

#include "nodes/config/config_tree.hpp"
#include "nodes/config/rtg_config.hpp"

namespace rtg {

/// Throws ConfigError, with the place in `root`, if objects cannot be moved about by one of the
/// jitters of `config`: see allows_jitter().
void check_jitters(const RtgConfig& config, const ConfigNode& root);

}  // namespace rtg

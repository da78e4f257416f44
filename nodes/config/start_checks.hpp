#pragma once

#include "nodes/config/config.hpp"
#include "nodes/config/config_tree.hpp"

namespace rtg::config {

/// Throws ConfigError, with the place in `root`, if too few random starts are legal for one of the
/// jitter amplitudes of `config`; see allows_jitter().
void check_jitters(const Config& config, const ConfigNode& root);

}  // namespace rtg::config

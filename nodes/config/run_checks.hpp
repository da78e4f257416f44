#pragma once

#include "nodes/config/config.hpp"
#include "nodes/config/config_tree.hpp"

namespace rtg::config {

/// Refuses values that are legal each but do not go together in a run: a learner without what it
/// learns from or with what it cannot use, a replay buffer smaller than the data (also where only
/// data are made: they are there to be learned from), messages to record where there are none.
/// Throws ConfigError with the place in `root` of a value that is part of it.
void check_run(const Config& config, const ConfigNode& root);

}  // namespace rtg::config

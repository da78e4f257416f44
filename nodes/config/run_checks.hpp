#pragma once

#include "nodes/config/config.hpp"
#include "nodes/config/config_tree.hpp"

namespace rtg::config {

/// Throws ConfigError for values that are each legal but inconsistent in one run: a learner without
/// the data that it needs or with data that it cannot use; a replay buffer smaller than the offline
/// data (even if the run only generates them, since they are meant for learning); recording of
/// messages in a run without messages. The error names the place in `root` of one of the values.
void check_run(const Config& config, const ConfigNode& root);

}  // namespace rtg::config

#pragma once

#include "nodes/config/config.hpp"
#include "nodes/config/config_tree.hpp"

namespace rtg::config {

/// Throws ConfigError for values that are each legal but do not fit together in one run:
///
///  - a learner without the data that it needs, or with data that it cannot use;
///  - a replay buffer smaller than the offline data, even if the run does not learn;
///  - recording of messages in a run without messages.
///
/// The error names the place in `root` where one of the values is given.
void check_run(const Config& config, const ConfigNode& root);

}  // namespace rtg::config

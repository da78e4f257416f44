#pragma once

#include <cstdint>

#include "core/search/report.hpp"
#include "core/search/seams.hpp"
#include "core/search/search_config.hpp"
#include "core/tasks/task.hpp"

namespace rtg::search {

/// Generates a data set by Algorithm 1 and returns the report. Trees of reverse steps grow from
/// goal states to the start layout. Every step whose plan succeeds in the forward simulator is
/// stored as simulated there, with its branches. With another config.generator the steps come from
/// other sources (forward_search.hpp, walks.hpp). A pure function of (task, config, seed) and the
/// seams.
GenerationReport generate(const tasks::Task& task, const SearchConfig& config, std::uint64_t seed,
                          const GenerationSeams& seams);

}  // namespace rtg::search

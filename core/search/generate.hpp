#pragma once

#include <cstdint>

#include "core/search/report.hpp"
#include "core/search/seams.hpp"
#include "core/search/search_config.hpp"
#include "core/tasks/task.hpp"

namespace rtg::search {

/// The whole generation, Algorithm 1: trees of reverse steps grow from goal states to the start
/// layout; every step whose plan the forward simulator carries out to success is stored as what it
/// makes of it, with its branches. With another config.generator the steps come from elsewhere
/// (forward_search.hpp, walks.hpp). A pure function of (task, config, seed) and the seams.
GenerationReport generate(const tasks::Task& task, const SearchConfig& config, std::uint64_t seed,
                          const GenerationSeams& seams);

}  // namespace rtg::search

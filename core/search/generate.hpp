#pragma once

#include <cstdint>

#include "core/search/report.hpp"
#include "core/search/seams.hpp"
#include "core/search/search_config.hpp"
#include "core/tasks/task.hpp"

namespace rtg::search {

/// Generates a data set and returns the report. By default it runs Algorithm 1: trees of reverse
/// steps grow from goal states towards start states. A step is stored if its plan succeeds in the
/// forward simulator. It is stored as simulated there, followed by its branches (branches.hpp).
/// Other values of config.generator: see forward_search.hpp and walks.hpp. Apart from the times in
/// the report, a pure function of `task`, `config`, `seed` and the functions in `seams`.
GenerationReport generate(const tasks::Task& task, const SearchConfig& config, std::uint64_t seed,
                          const GenerationSeams& seams);

}  // namespace rtg::search

#pragma once

#include <cstdint>
#include <functional>

#include "core/search/batches.hpp"
#include "core/search/report.hpp"
#include "core/search/search_config.hpp"
#include "core/search/transition.hpp"
#include "core/tasks/task.hpp"

namespace rtg {

/// Everything the search needs from outside of itself.
struct GenerationSeams {
  SolveBatch solve;
  ReplayBatch replay;
  TransitionSink store;  // receives every transition, in order
  // Called and polled after each layer or wave; may be empty.
  std::function<void(const Progress&)> progress = {};
  std::function<bool()> cancelled = {};
};

/// The whole generation, Algorithm 1: trees of reverse steps grow from goal states to the start
/// layout; every step whose plan the forward simulator carries out to success is stored as what it
/// makes of it, with its branches. With another config.generator the steps come from elsewhere
/// (forward_search.hpp, walks.hpp). A pure function of (task, config, seed) and the seams.
GenerationReport generate(const Task& task, const SearchConfig& config, std::uint64_t seed,
                          const GenerationSeams& seams);

}  // namespace rtg

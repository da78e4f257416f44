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
  // Called and polled after each layer of trees and each wave of episodes; may be empty.
  std::function<void(const Progress&)> progress = {};
  std::function<bool()> cancelled = {};
};

/// The whole generation: trees of reverse steps from sampled goals (beam search), first towards the
/// start, then to where the tree policy still gets lost (exploration.hpp); forward replay of the
/// best predecessors found, end-to-end replay of chains; then, where episodes of the policy fail,
/// plans searched forwards (plan_search.hpp). A search that covers a task finds far more
/// steps than a learner can use: stored are those that episodes of the policy use, and others drawn
/// at random, all with the plans behind them; the policy keeps to these. Last, roll-outs of the
/// policy. A pure function of (task, config, seed) and the seams.
GenerationReport generate(const Task& task, const SearchConfig& config, std::uint64_t seed,
                          const GenerationSeams& seams);

}  // namespace rtg

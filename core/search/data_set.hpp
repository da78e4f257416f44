#pragma once

#include <cstdint>
#include <span>
#include <unordered_set>

#include "core/search/coverage.hpp"
#include "core/search/seams.hpp"
#include "core/search/search_config.hpp"
#include "core/search/transition.hpp"
#include "core/tasks/task.hpp"

namespace rtg::search {

/// The stored transitions as they come about: steps, each followed by its branches, until
/// config.transitions are there.
class DataSet {
 public:
  /// All arguments must outlive it. `sink` receives the transitions.
  DataSet(const tasks::Task& task, const SearchConfig& config, std::uint64_t seed,
          const TransitionSink& sink)
      : task_(task), config_(config), seed_(seed), sink_(sink), coverage_(task) {}

  /// Stores the first of `steps` with their branches, as far as there is room; nothing twice.
  /// `replay` says what the branches lead to.
  void store(std::span<const Transition> steps, const ReplayBatch& replay);

  bool full() const { return coverage_.transitions() >= config_.transitions; }
  const Coverage& coverage() const { return coverage_; }

 private:
  const tasks::Task& task_;
  const SearchConfig& config_;
  std::uint64_t seed_;
  const TransitionSink& sink_;
  Coverage coverage_;
  std::unordered_set<std::uint64_t> known_;  // key_of() state and action of all
};

}  // namespace rtg::search

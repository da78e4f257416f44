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

/// The data set of a run: generated steps, each followed by its branches (with_branches()). It is
/// full when it has config.transitions transitions. It passes them on to a sink.
class DataSet {
 public:
  /// All arguments must outlive the DataSet. `sink` receives the transitions.
  DataSet(const tasks::Task& task, const SearchConfig& config, std::uint64_t seed,
          const TransitionSink& sink)
      : task_(task),
        config_(config),
        seed_(seed),
        sink_(sink),
        left_(config.transitions),
        coverage_(task) {}

  /// Forgets which transitions are stored. From now on it is full after `count` further ones.
  void begin_shard(int count);

  /// Stores each step, followed by its branches, until the data set is full. Skips a transition
  /// whose state and action are stored already. `replay` simulates the branches.
  void store(std::span<const Transition> steps, const ReplayBatch& replay);

  bool full() const { return left_ == 0; }
  long left() const { return left_; }      // transitions until it is full
  long stored() const { return stored_; }  // transitions since begin_shard()
  const Coverage& coverage() const { return coverage_; }

 private:
  const tasks::Task& task_;
  const SearchConfig& config_;
  std::uint64_t seed_;
  const TransitionSink& sink_;
  long left_, stored_ = 0;
  Coverage coverage_;
  std::unordered_set<std::uint64_t> known_;  // key_of() of each stored state and action
};

}  // namespace rtg::search

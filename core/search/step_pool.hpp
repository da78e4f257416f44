#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "core/search/transition.hpp"

namespace rtg {

/// The steps that the search has found, each with the one behind it in its plan. Those that are
/// taken, to be stored, are taken with the whole plan behind them: on its own a step tells a
/// learner nothing.
class StepPool {
 public:
  using Index = std::size_t;

  /// Adds a step; `next`: the one behind it, if it ends where that begins, about. One whose start
  /// and action are known stays, but takes up a plan to success if it has none.
  void add(Transition step, std::optional<Index> next);

  /// The step with this start and action (key_of()).
  std::optional<Index> find(std::uint64_t key) const;

  /// Whether its plan goes on to success.
  bool leads(Index k) const;
  std::size_t size() const { return steps_.size(); }

  /// A step and its plan, in this order, without those that have been taken before; no more than
  /// `room`.
  std::vector<Transition> take(Index k, std::size_t room);

  /// Keys of what has been taken.
  const std::unordered_set<std::uint64_t>& taken() const { return taken_; }

 private:
  struct Entry {
    Transition step;
    std::uint64_t key;
    std::optional<Index> next;
  };
  std::vector<Entry> steps_;
  std::unordered_map<std::uint64_t, Index> at_;  // by key
  std::unordered_set<std::uint64_t> taken_;
};

}  // namespace rtg

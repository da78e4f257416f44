#pragma once

#include <array>
#include <cstdint>
#include <unordered_set>
#include <vector>

#include "core/search/transition.hpp"
#include "core/tasks/task.hpp"

namespace rtg::search {

/// Statistics of a stream of transitions.
class Coverage {
 public:
  struct Figures {
    long transitions = 0;
    std::array<long, kSources.size()> by_source{};
    double contact_share = 0.0;       // share that moves an object by more than kMoved
    double multi_body_share = 0.0;    // share that moves several objects not connected by joints
    double headings_per_state = 0.0;  // transitions per distinct state

    long of(Source source) const { return by_source[static_cast<std::size_t>(source)]; }
  };

  explicit Coverage(const tasks::Task& task);

  void add(const Transition& transition);
  long transitions() const { return transitions_; }
  Figures figures() const;

 private:
  bool moves_several(const Transition& t) const;

  std::vector<std::size_t> group_roots_;  // moving_group_roots() of the scene
  long transitions_ = 0, contacts_ = 0, multi_body_ = 0;
  std::array<long, kSources.size()> by_source_{};
  std::unordered_set<std::uint64_t> states_;  // key_of() of each
};

}  // namespace rtg::search

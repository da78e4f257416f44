#include "core/search/coverage.hpp"

#include <algorithm>

#include "core/reverse/problem/reverse_job.hpp"
#include "core/search/predecessor.hpp"

namespace rtg::search {

Coverage::Coverage(const tasks::Task& task) : group_roots_(moving_group_roots(task.scene)) {}

/// Returns whether `t` moves two objects that are not connected by joints.
bool Coverage::moves_several(const Transition& t) const {
  std::size_t first = 0;
  for (std::size_t k = 1; k < t.poses.size(); ++k) {
    if (!has_moved(t.poses[k], t.next[k])) continue;
    if (first != 0 && group_roots_[k] != first) return true;
    first = group_roots_[k];
  }
  return false;
}

void Coverage::add(const Transition& t) {
  ++transitions_;
  ++by_source_[static_cast<std::size_t>(t.source)];
  contacts_ += objects_moved(t.poses, t.next) >= 1;
  multi_body_ += moves_several(t);
  states_.insert(reverse::key_of(t.poses, 0));
}

Coverage::Figures Coverage::figures() const {
  const double count = static_cast<double>(std::max(transitions_, 1L));
  const double states = static_cast<double>(std::max(states_.size(), std::size_t{1}));
  return {transitions_, by_source_, contacts_ / count, multi_body_ / count, transitions_ / states};
}

}  // namespace rtg::search

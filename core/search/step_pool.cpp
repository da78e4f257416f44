#include "core/search/step_pool.hpp"

#include <utility>

#include "core/reverse/reverse_job.hpp"

namespace rtg {

void StepPool::add(Transition step, std::optional<Index> next) {
  const std::uint64_t key = key_of(step.poses, step.action);
  if (!at_.try_emplace(key, steps_.size()).second) return;
  const bool leads = step.success || (next && steps_[*next].leads);
  steps_.push_back({std::move(step), key, next, leads});
}

std::optional<StepPool::Index> StepPool::find(std::uint64_t key) const {
  const auto at = at_.find(key);
  return at == at_.end() ? std::nullopt : std::optional(at->second);
}

std::vector<Transition> StepPool::take(Index k, std::size_t room) {
  std::vector<Transition> out;
  for (std::optional<Index> at = k; at && out.size() < room; at = steps_[*at].next) {
    const Entry& entry = steps_[*at];
    if (!taken_.insert(entry.key).second) break;  // so are those behind it
    out.push_back(entry.step);
  }
  return out;
}

}  // namespace rtg

#include "core/search/step_pool.hpp"

#include <utility>

#include "core/reverse/reverse_job.hpp"

namespace rtg {

void StepPool::add(Transition step, std::optional<Index> next) {
  const std::uint64_t key = key_of(step.poses, step.action);
  const auto [at, is_new] = at_.try_emplace(key, steps_.size());
  if (is_new)
    steps_.push_back({std::move(step), key, next});
  else if (next && leads(*next) && !leads(at->second))  // so it is not behind *next
    steps_[at->second].next = next;
}

bool StepPool::leads(Index k) const {
  std::optional<Index> at = k;
  while (at && !steps_[*at].step.success) at = steps_[*at].next;
  return at.has_value();
}

std::optional<StepPool::Index> StepPool::find(std::uint64_t key) const {
  const auto at = at_.find(key);
  return at == at_.end() ? std::nullopt : std::optional(at->second);
}

std::vector<Transition> StepPool::take(Index k, std::size_t room) {
  std::vector<Transition> out;
  for (std::optional<Index> at = k; at && out.size() < room; at = steps_[*at].next) {
    const Entry& entry = steps_[*at];
    if (taken_.insert(entry.key).second) out.push_back(entry.step);
  }
  return out;
}

}  // namespace rtg

#include "core/search/lost_state.hpp"

#include <algorithm>

namespace rtg {

std::optional<Poses> lost_state(const Task& task, const TreePolicy& policy,
                                std::span<const Poses> starts, const ReplayBatch& replay,
                                SearchStats& stats) {
  if (policy.size() == 0) return std::nullopt;
  for (const Episode& e : run_episodes(task, policy, {starts}, replay, stats)) {
    const auto far = std::ranges::find_if(e.strayed, [](double d) { return d > kLost; });
    if (!e.success && far != e.strayed.end())
      return e.steps[static_cast<std::size_t>(far - e.strayed.begin())].poses;
  }
  return std::nullopt;
}

}  // namespace rtg

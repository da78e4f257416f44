#include "core/search/branches.hpp"

#include "core/math/draws.hpp"
#include "core/reverse/problem/reverse_job.hpp"

namespace rtg::search {

std::vector<int> other_actions(int action, int actions, int count, Rng& rng) {
  std::vector<int> others;
  for (int away = 1; away < actions; ++away) others.push_back((action + away) % actions);
  return drawn(others, count, rng);
}

std::vector<Transition> with_branches(const tasks::Task& task, std::span<const Transition> steps,
                                      const SearchConfig& config, std::uint64_t seed,
                                      const ReplayBatch& replay) {
  std::vector<ReplayJob> pushes;
  std::vector<std::size_t> ends;  // end of each step's branches in `pushes`
  for (const Transition& step : steps) {
    Rng rng(seed, reverse::key_of(step.poses, step.action));
    for (const int other :
         other_actions(step.action, action_count(task.push), config.branches, rng))
      pushes.push_back({step.poses, other});
    ends.push_back(pushes.size());
  }
  const std::vector<ReplayResult> results = replay(pushes);
  std::vector<Transition> out;
  for (std::size_t k = 0, push = 0; k < steps.size(); ++k) {
    out.push_back(steps[k]);
    for (; push < ends[k]; ++push)
      if (results[push].ok)
        out.push_back(transition(task, pushes[push], results[push].end, Source::kBranch));
  }
  return out;
}

}  // namespace rtg::search

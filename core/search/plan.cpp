#include "core/search/plan.hpp"

#include <utility>

namespace rtg::search {

std::vector<PlanOutcome> carry_out(const tasks::Task& task, std::span<const Plan> plans,
                                   const ReplayBatch& replay) {
  std::vector<PlanOutcome> done(plans.size());
  std::vector<std::vector<Transition>> steps(plans.size());
  std::vector<std::size_t> going;  // plans that have neither succeeded nor failed
  for (std::size_t k = 0; k < plans.size(); ++k) {
    if (succeeded(task, plans[k].start)) done[k].emplace();
    if (!done[k]) going.push_back(k);
  }
  for (std::size_t step = 0; !going.empty(); ++step) {
    std::erase_if(going, [&](std::size_t k) { return plans[k].actions.size() == step; });
    std::vector<ReplayJob> pushes;
    for (const std::size_t k : going) {
      const Poses& state = steps[k].empty() ? plans[k].start : steps[k].back().next;
      pushes.push_back({state, plans[k].actions[step]});
    }
    const std::vector<ReplayResult> results = replay(pushes);
    std::vector<std::size_t> left;
    for (std::size_t j = 0; j < going.size(); ++j) {
      const std::size_t k = going[j];
      if (!results[j].ok) continue;
      steps[k].push_back(transition(task, pushes[j], results[j].end, Source::kTree));
      if (steps[k].back().success) done[k] = std::move(steps[k]);
      if (!done[k]) left.push_back(k);
    }
    going = std::move(left);
  }
  return done;
}

}  // namespace rtg::search

#include "core/search/plan.hpp"

#include <utility>

namespace rtg::search {

std::vector<PlanOutcome> carry_out(const tasks::Task& task, std::span<const Plan> plans,
                                   const ReplayBatch& replay) {
  std::vector<PlanOutcome> outcomes(plans.size());
  std::vector<std::size_t> going;  // plans that have neither succeeded nor failed
  for (std::size_t k = 0; k < plans.size(); ++k) {
    outcomes[k].success = succeeded(task, plans[k].start);
    if (!outcomes[k].success) going.push_back(k);
  }
  for (std::size_t step = 0; !going.empty(); ++step) {
    std::erase_if(going, [&](std::size_t k) { return plans[k].actions.size() == step; });
    std::vector<ReplayJob> pushes;
    for (const std::size_t k : going) {
      const std::vector<Transition>& before = outcomes[k].steps;
      pushes.push_back({step == 0 ? plans[k].start : before.back().next, plans[k].actions[step]});
    }
    const std::vector<ReplayResult> results = replay(pushes);
    std::vector<std::size_t> left;
    for (std::size_t j = 0; j < going.size(); ++j) {
      const std::size_t k = going[j];
      if (!results[j].ok) continue;
      outcomes[k].steps.push_back(transition(task, pushes[j], results[j].end, Source::kTree));
      outcomes[k].success = outcomes[k].steps.back().success;
      if (!outcomes[k].success) left.push_back(k);
    }
    going = std::move(left);
  }
  return outcomes;
}

}  // namespace rtg::search

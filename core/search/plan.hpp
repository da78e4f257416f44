#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/search/seams.hpp"
#include "core/search/transition.hpp"
#include "core/tasks/task.hpp"

namespace rtg::search {

/// A state `start` and the actions that should lead from it to success.
struct Plan {
  Poses start;
  std::vector<int> actions;
};

/// Simulates all plans in parallel, one push of each per call of `replay`. Returns the transitions
/// of each plan up to the first success. They are empty if the goal holds in the start. Returns
/// std::nullopt for a plan that does not succeed or has a push that the simulator rejects. The
/// transitions have Source::kTree.
std::vector<std::optional<std::vector<Transition>>> carry_out(const tasks::Task& task,
                                                              std::span<const Plan> plans,
                                                              const ReplayBatch& replay);

}  // namespace rtg::search

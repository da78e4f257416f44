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

/// The transitions of a plan up to the first success, with Source::kTree. They are empty if the
/// goal holds in the start. Nothing if the plan does not succeed or if the simulator rejects a
/// push.
using PlanOutcome = std::optional<std::vector<Transition>>;

/// Simulates all plans in parallel, one push of each per call of `replay`.
std::vector<PlanOutcome> carry_out(const tasks::Task& task, std::span<const Plan> plans,
                                   const ReplayBatch& replay);

}  // namespace rtg::search

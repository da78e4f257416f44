#pragma once

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

/// What came of a plan.
struct PlanOutcome {
  bool success = false;
  /// The transitions up to the first success or to a push that the simulator rejects, with
  /// Source::kTree. They are empty if the goal holds in the start.
  std::vector<Transition> steps;
};

/// Simulates all plans in parallel, one push of each per call of `replay`.
std::vector<PlanOutcome> carry_out(const tasks::Task& task, std::span<const Plan> plans,
                                   const ReplayBatch& replay);

}  // namespace rtg::search

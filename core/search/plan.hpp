#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/search/seams.hpp"
#include "core/search/transition.hpp"
#include "core/tasks/task.hpp"

namespace rtg::search {

/// A state and the actions that should lead from it to success.
struct Plan {
  Poses start;
  std::vector<int> actions;
};

/// Carries out plans in the simulator, all side by side: the transitions up to the first success,
/// none where the start succeeds already. Nothing for a plan that does not succeed, or whose push
/// the simulator rejects. The transitions are of Source::kTree.
std::vector<std::optional<std::vector<Transition>>> carry_out(const tasks::Task& task,
                                                              std::span<const Plan> plans,
                                                              const ReplayBatch& replay);

}  // namespace rtg::search

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

/// Carries out plans in the simulator, all side by side. Returns for each plan the transitions up
/// to the first success, an empty vector if the start succeeds already. Returns std::nullopt for a
/// plan that does not succeed or of which the simulator rejects a push. The transitions have
/// Source::kTree.
std::vector<std::optional<std::vector<Transition>>> carry_out(const tasks::Task& task,
                                                              std::span<const Plan> plans,
                                                              const ReplayBatch& replay);

}  // namespace rtg::search

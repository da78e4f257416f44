#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/math/rng.hpp"
#include "core/search/seams.hpp"
#include "core/search/search_config.hpp"
#include "core/search/transition.hpp"
#include "core/tasks/task.hpp"

namespace rtg::search {

/// Draws config.branches different headings other than `action`: config.near_branches of them at
/// most config.near_headings away from `action`, the rest anywhere. Returns fewer only if there are
/// no more.
std::vector<int> other_headings(int action, int headings, const SearchConfig& config, Rng& rng);

/// Returns each step followed by its branches: the true outcomes of other headings in the state in
/// which the step begins. A reverse step shows the outcome of one heading only, which nearly always
/// leads towards the goal. To choose among headings, a learner needs the outcomes of others as
/// well. The headings are a function of the step and `seed`. Pushes that the simulator rejects are
/// left out.
std::vector<Transition> with_branches(const tasks::Task& task, std::span<const Transition> steps,
                                      const SearchConfig& config, std::uint64_t seed,
                                      const ReplayBatch& replay);

}  // namespace rtg::search

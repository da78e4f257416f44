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

/// Headings other than `action`, all different: config.near_branches up to config.near_headings
/// away from it, the rest of config.branches anywhere; fewer only where there are no more.
std::vector<int> other_headings(int action, int headings, const SearchConfig& config, Rng& rng);

/// Each step followed by its branches: the true outcomes of other headings in the state in which
/// it begins. A reverse step says what one heading of a state does and nearly always leads on; what
/// the other headings do, a learner has to know as well to choose among them. Which headings is a
/// function of the step and `seed`. Pushes that the simulator rejects are left out.
std::vector<Transition> with_branches(const tasks::Task& task, std::span<const Transition> steps,
                                      const SearchConfig& config, std::uint64_t seed,
                                      const ReplayBatch& replay);

}  // namespace rtg::search

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

/// Draws `count` distinct actions other than `action`, of `actions` in all. Returns fewer if there
/// are not enough.
std::vector<int> other_actions(int action, int actions, int count, Rng& rng);

/// Returns each step followed by its branches: simulated pushes in other directions from the same
/// state. A reverse step shows one heading only, which nearly always leads towards the goal. A
/// learner that chooses among headings must know the outcomes of others, too. The headings of the
/// branches depend on the step and `seed` only. Pushes that the simulator rejects are left out.
///
/// Departs from the paper: its offline transitions are steps of trees alone. With 68,000 of them a
/// learner of Sorting learns nothing in 170,000 interactions; with 13,600 and 54,400 branches its
/// success is 0.96 after 60,000 to 75,000 (trials, one seed). In the records (docs/results/third,
/// three seeds) it is 0.95 after 48,000 ± 3,000.
std::vector<Transition> with_branches(const tasks::Task& task, std::span<const Transition> steps,
                                      const SearchConfig& config, std::uint64_t seed,
                                      const ReplayBatch& replay);

}  // namespace rtg::search

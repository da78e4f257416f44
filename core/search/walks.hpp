#pragma once

#include "core/search/generation.hpp"

namespace rtg::search {

/// Runs wave number `number` of random walks, 50 at a time, and stores their pushes. With
/// Generator::kRandom (the baseline of App. D) walks begin at random starts, run.draw_start(). With
/// kScatter they begin at goal states. Half of the pushes seek contact (contact_heading()); the
/// others are uniform. A walk ends after task.horizon pushes, from a goal state after 6 pushes, or
/// when the simulator rejects one. Pushes from states in which the goal holds are not stored.
void walk(Generation& run, int number);

}  // namespace rtg::search

#pragma once

#include "core/search/generation.hpp"

namespace rtg::search {

/// Data without any search: a wave of random walks, half of whose pushes seek contact
/// (contact_heading()), from starts (run.draw_start(); Generator::kRandom: the baseline of App. D),
/// or from goal states (kScatter). A walk ends at the horizon or with a push that the simulator
/// rejects; what it does in states in which the goal holds is not stored. Number `number` of the
/// waves.
void walk(Generation& run, int number);

}  // namespace rtg::search

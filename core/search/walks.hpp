#pragma once

#include "core/search/generation.hpp"

namespace rtg::search {

/// Runs wave number `number` of random walks and stores their pushes: data without any search. Half
/// of the pushes seek contact (contact_heading()). With Generator::kRandom, the baseline of App. D,
/// the walks begin at starts (run.draw_start()); with kScatter they begin at goal states. A walk
/// ends at the horizon or with a push that the simulator rejects. Pushes in states in which the
/// goal holds are not stored.
void walk(Generation& run, int number);

}  // namespace rtg::search

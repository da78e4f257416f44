#pragma once

#include <cstdint>

#include "core/search/generate.hpp"

namespace rtg {

/// The baseline of App. D: a data set without a search, of episodes of the uniform random policy.
/// They begin at starts with objects moved by up to ± config.rollout_jitter and end at success, at
/// the horizon or with a push that the simulator rejects; config.transitions are stored, as
/// roll-outs. A pure function of (task, config, seed) and the seams, of which `solve` is not used.
GenerationReport random_episodes(const Task& task, const SearchConfig& config, std::uint64_t seed,
                                 const GenerationSeams& seams);

}  // namespace rtg

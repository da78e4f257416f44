#pragma once

#include <optional>
#include <span>

#include "core/search/roll_out.hpp"

namespace rtg {

/// Where the data lacks something: of the first episode that fails after its policy has got lost,
/// the first state in which it was. Nothing if there is none.
std::optional<Poses> lost_state(std::span<const Episode> episodes);

/// The steps of an episode; of one that fails only kAfter from where its policy got lost on, as the
/// rest are those of any random walk.
std::span<const Transition> worth_keeping(const Episode& episode);
inline constexpr std::size_t kAfter = 4;

}  // namespace rtg

#pragma once

#include <optional>
#include <span>

#include "core/search/roll_out.hpp"

namespace rtg {

/// Where the data lacks something: of the first episode that fails after its policy has got lost,
/// the first state in which it was. Nothing if there is none.
std::optional<Poses> lost_state(std::span<const Episode> episodes);

}  // namespace rtg

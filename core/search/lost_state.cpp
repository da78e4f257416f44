#include "core/search/lost_state.hpp"

#include <algorithm>

namespace rtg {

std::optional<Poses> lost_state(std::span<const Episode> episodes) {
  for (const Episode& e : episodes) {
    const auto far = std::ranges::find_if(e.strayed, [](double d) { return d > kLost; });
    if (!e.success && far != e.strayed.end())
      return e.steps[static_cast<std::size_t>(far - e.strayed.begin())].poses;
  }
  return std::nullopt;
}

}  // namespace rtg

#include "core/search/lost_state.hpp"

#include <algorithm>

namespace rtg {
namespace {

/// The first step at which the policy is lost; none: the number of steps.
std::size_t lost_at(const Episode& e) {
  const auto far = std::ranges::find_if(e.strayed, [](double d) { return d > kLost; });
  return static_cast<std::size_t>(far - e.strayed.begin());
}

}  // namespace

std::optional<Poses> lost_state(std::span<const Episode> episodes) {
  for (const Episode& e : episodes)
    if (const std::size_t at = lost_at(e); !e.success && at < e.steps.size())
      return e.steps[at].poses;
  return std::nullopt;
}

std::span<const Transition> worth_keeping(const Episode& e) {
  const bool wandered = !e.success && !e.used.empty();
  const std::size_t kept = wandered ? lost_at(e) + kAfter : e.steps.size();
  return std::span(e.steps).first(std::min(kept, e.steps.size()));
}

}  // namespace rtg

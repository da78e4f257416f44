#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "core/world/pose.hpp"

namespace rtg::search {

/// Source of a stored transition.
enum class Source : std::int8_t {
  kTree,     // a reverse step, simulated forwards
  kBranch,   // another heading from the state in which a stored step begins
  kWalk,     // a push of a random walk
  kForward,  // a step that a forward beam search kept
};
inline constexpr std::array<std::string_view, 4> kSources{"tree", "branch", "walk", "forward"};

/// A transition of the true dynamics (Box2D). `success`: the goal holds in `next`.
struct Transition {
  Poses poses;
  int action = 0;
  Poses next;
  bool success = false;  // reward 1 and terminated
  Source source = Source::kTree;

  bool operator==(const Transition&) const = default;
};

}  // namespace rtg::search

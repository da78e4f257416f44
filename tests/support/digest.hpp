#pragma once

#include <bit>
#include <cstdint>
#include <span>

#include "core/math/hash.hpp"
#include "core/search/transition.hpp"

namespace rtg::testing {

/// Returns `hash` updated with every bit of the transitions.
inline std::uint64_t digest(std::uint64_t hash, std::span<const search::Transition> transitions) {
  for (const search::Transition& one : transitions) {
    for (const Poses* poses : {&one.poses, &one.next})
      for (const Pose& pose : *poses)
        for (const double x : {pose.x, pose.y, pose.theta})
          hash = hashed(hash, std::bit_cast<std::uint64_t>(x));
    for (const int x : {one.action, static_cast<int>(one.success), static_cast<int>(one.source)})
      hash = hashed(hash, static_cast<std::uint64_t>(x));
  }
  return hash;
}

}  // namespace rtg::testing

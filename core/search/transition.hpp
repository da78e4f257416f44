#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "core/world/pose.hpp"

namespace rtg {

/// Where a stored transition comes from.
enum class Source : std::int8_t {
  kStepReplay,   // one reverse candidate replayed forward
  kChainReplay,  // part of a whole chain replayed end to end from its far end, but for its first
                 // step and any other that is stored already
  kRollOut,      // part of an episode of the tree policy, or the random one, from a jittered start
  kMended,  // part of a plan found forwards where an episode of the tree policy failed, or of an
            // episode that succeeded meanwhile
};

/// One true transition of the true dynamics (Box2D). Success is the task's predicate on `next`.
struct Transition {
  Poses poses;
  int action = 0;
  Poses next;
  bool success = false;  // reward 1 and terminated
  Source source = Source::kStepReplay;

  bool operator==(const Transition&) const = default;
};

/// Receives transitions in sequence order; the k-th transition of a run has sequence number k.
using TransitionSink = std::function<void(std::span<const Transition>)>;

}  // namespace rtg

#pragma once

#include <utility>

#include "core/world/physics_config.hpp"
#include "core/world/push.hpp"
#include "core/world/scene.hpp"

namespace rtg::forward {

/// Outcome of a push: `end` is the state after it. `ok` is false if the start is not usable, a
/// state is not finite or the simulator reached an iteration limit. `end` is then the start or the
/// last good state, and must not be used as a transition.
struct PushOutcome {
  Poses end;
  bool ok = true;
};

/// Forward dynamics of a scene that is at rest before and after a push. Equal arguments give
/// bit-equal results. Thread-safe: implementations hold no mutable state.
class Simulator {
 public:
  explicit Simulator(PushConfig push) : push_(std::move(push)) {}
  virtual ~Simulator() = default;

  /// Simulates the push of an action, see push_along().
  [[nodiscard]] PushOutcome push(const Poses& start, int action) const {
    return push_along(start, stroke_of(action, push_));
  }

  /// Simulates a push: the robot moves straight to push_target() with bounded force and torque,
  /// without turning. Then everything comes to rest. `start` has one pose per body; the length of
  /// the stroke is above 0.
  [[nodiscard]] virtual PushOutcome push_along(const Poses& start, const Stroke& stroke) const = 0;

  /// Lets the scene come to rest with the robot held.
  [[nodiscard]] virtual PushOutcome settle(const Poses& start) const = 0;

 protected:
  PushConfig push_;
};

}  // namespace rtg::forward

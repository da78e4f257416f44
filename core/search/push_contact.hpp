#pragma once

#include <span>
#include <vector>

#include "core/world/push.hpp"
#include "core/world/scene.hpp"

namespace rtg {

/// How a push meets the bodies before it: numbers that are close for two states in which the same
/// action does about the same. Of every body but the robot, W the area that the robot sweeps if
/// nothing stops it, not even the edge of the arena, d the direction of the push:
///
///   cut  = -separation(W, body) where they overlap, else 0 [m]: how far the robot would push it
///          (up to about half the widths of both), or how deep it would graze it;
///   side = cut · (t_body - t_robot)·d⊥ / 1 m: as far as it is met, how far to the left.
class PushContact {
 public:
  /// `heading`: the robot's. Every push holds it to about 1e-3 rad, so that of a state does not
  /// matter.
  PushContact(Scene scene, PushConfig push, double heading);

  /// Two numbers per body but the robot.
  int size() const { return 2 * (static_cast<int>(scene_.size()) - 1); }

  /// Writes the cuts, then the sides; out [size()].
  void describe(const Poses& state, int action, std::span<float> out) const;

 private:
  Scene scene_;
  PushConfig push_;
  double heading_;
  std::vector<Polygon> ways_;  // W of each action, in a frame turned by heading_
};

}  // namespace rtg

#pragma once

#include "core/world/pose.hpp"

namespace rtg {

/// Parameters of the discrete action set. Action a pushes straight along the unit vector d(a),
/// while the robot's angle is held:
///
///   d(a) = (cos 2πa/n, sin 2πa/n).
struct PushConfig {
  int headings = 48;    // n
  double stride = 2.0;  // length of one push [m]
  double arena = 8.0;   // the robot's target is clipped to |x|, |y| ≤ arena [m]

  template <class Visitor>
  void visit(Visitor& v) {
    v.integer("headings", headings, 1, 360, "number of push directions");
    v.length("stride", stride, 0.01, 100.0, "length of one push [m]");
    v.length("arena", arena, 0.1, 1000.0, "half width of the square the robot stays in [m]");
  }
};

/// Returns d(a), the unit vector of action a ∈ {0, ..., headings-1}.
Vector2d direction(int action, const PushConfig& config);

/// Returns the robot's target pose for `action` from the pose `robot`: one stride along d(a), with
/// the same angle. Each coordinate is clipped to the arena.
Pose push_target(const Pose& robot, int action, const PushConfig& config);

/// Returns whether a robot pose lies in the arena.
bool in_arena(const Pose& robot, const PushConfig& config);

}  // namespace rtg

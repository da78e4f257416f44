#pragma once

#include <vector>

#include "core/world/pose.hpp"

namespace rtg {

/// Parameters of the discrete action set: n headings with each of the strides ℓ. Action a pushes
/// straight by ℓ(a) along the unit vector d(a), while the robot's angle is held:
///
///   d(a) = (cos 2πa/n, sin 2πa/n),   ℓ(a) = ℓ_k,   k = ⌊a/n⌋.
struct PushConfig {
  int headings = 48;                 // n
  std::vector<double> strides{2.0};  // ℓ_k, lengths of a push [m]
  double arena = 8.0;                // the robot's target is clipped to |x|, |y| ≤ arena [m]

  /// Shows the fields but for the strides to `v`.
  template <class Visitor>
  void visit(Visitor& v) {
    v.integer("headings", headings, 1, 360, "number of push directions");
    v.length("arena", arena, 0.1, 1000.0, "half width of the square the robot stays in [m]");
  }
};

/// Returns the number of actions.
int action_count(const PushConfig& config);

/// Returns which of the strides an action has, and its length.
int stride_index(int action, const PushConfig& config);
double stride_of(int action, const PushConfig& config);
double longest_stride(const PushConfig& config);

/// Returns the action set with the stride of `action` alone.
PushConfig with_stride_of(int action, const PushConfig& config);

/// Returns d(a), the unit vector of an action.
Vector2d direction(int action, const PushConfig& config);

/// A straight way of the robot: `length` [m] along the unit vector `direction`.
struct Stroke {
  Vector2d direction;
  double length = 0.0;
};

/// Returns the stroke of an action: ℓ(a) along d(a).
Stroke stroke_of(int action, const PushConfig& config);

/// Returns the robot's target pose for a stroke from the pose `robot`, with the same angle. Each
/// coordinate is clipped to the arena.
Pose push_target(const Pose& robot, const Stroke& stroke, const PushConfig& config);

/// Returns whether a robot pose lies in the arena.
bool in_arena(const Pose& robot, const PushConfig& config);

}  // namespace rtg

#pragma once

#include <optional>
#include <vector>

#include "core/tasks/task.hpp"

namespace rtg::tasks {

/// Distance that sample_goal() keeps between bodies [m]. Box2D treats bodies closer than 0.02 m as
/// in contact.
inline constexpr double kClearance = 0.0215;

/// A state that is being sampled. `poses[i]` is valid once body i is placed, that is `placed[i]`.
struct PartialState {
  Poses poses;
  std::vector<bool> placed;
};

/// Returns a placed body from which body `i` at `pose` does not keep kClearance, except those that
/// a joint connects with it; nothing if it is clear of all.
std::optional<std::size_t> blocker(const Task& task, const PartialState& state, std::size_t i,
                                   const Pose& pose);
bool is_clear(const Task& task, const PartialState& state, std::size_t i, const Pose& pose);

/// A straight motion of a body from `from` towards the placed bodies.
struct Approach {
  Pose from;
  Vector2d heading;    // unit vector
  double gap = 0.0;    // distance kept to the first placed body [m]
  double range = 0.0;  // greatest length of the motion [m]
};

/// Slides body `i` along `approach` until it is `gap` away from a placed body, and returns its pose
/// there. Returns nothing if it meets no body within `range` or starts closer than `gap` to one.
std::optional<Pose> slide(const Task& task, const PartialState& state, std::size_t i,
                          const Approach& approach);

}  // namespace rtg::tasks

#include "core/tasks/placement.hpp"

#include <algorithm>

#include "core/world/separation.hpp"

namespace rtg::tasks {
namespace {

constexpr double kSlideError = 1e-3;  // largest error of a gap after slide() [m]

/// Returns the least separation of body `i` at `pose` from all placed bodies, except those that a
/// joint connects with it.
double clearance(const Task& task, const PartialState& state, std::size_t i, const Pose& pose) {
  double least = 1e9;
  for (std::size_t j = 0; j < state.poses.size(); ++j)
    if (j != i && state.placed[j] && !jointed(task.scene, i, j))
      least = std::min(least, separation(task.scene.bodies[i].shape, pose,
                                         task.scene.bodies[j].shape, state.poses[j]));
  return least;
}

}  // namespace

std::optional<std::size_t> blocker(const Task& task, const PartialState& state, std::size_t i,
                                   const Pose& pose) {
  for (std::size_t j = 0; j < state.poses.size(); ++j)
    if (j != i && state.placed[j] && !jointed(task.scene, i, j) &&
        separation(task.scene.bodies[i].shape, pose, task.scene.bodies[j].shape, state.poses[j]) <
            kClearance - kSlideError)
      return j;
  return std::nullopt;
}

bool is_clear(const Task& task, const PartialState& state, std::size_t i, const Pose& pose) {
  return !blocker(task, state, i, pose);
}

/// Each step is as long as the separating-axis gap. That gap never exceeds the distance, so no step
/// passes through a body.
std::optional<Pose> slide(const Task& task, const PartialState& state, std::size_t i,
                          const Approach& approach) {
  Pose pose = approach.from;
  double gone = 0.0;
  while (gone < approach.range) {
    const double free = clearance(task, state, i, pose) - approach.gap;
    if (free < kSlideError) return free > -kSlideError ? std::optional(pose) : std::nullopt;
    pose.x += free * approach.heading.x();
    pose.y += free * approach.heading.y();
    gone += free;
  }
  return std::nullopt;
}

}  // namespace rtg::tasks

#include "core/tasks/placement.hpp"

#include <algorithm>
#include <limits>

#include "core/world/separation.hpp"

namespace rtg::tasks {
namespace {

constexpr double kSlideError = 1e-3;  // largest error of a gap after slide() [m]

/// Calls visit(j, separation [m]) for each placed body j that no joint connects with body `i`,
/// which is at `pose`.
void for_placed(const Task& task, const PartialState& state, std::size_t i, const Pose& pose,
                auto visit) {
  const std::vector<Body>& bodies = task.scene.bodies;
  for (std::size_t j = 0; j < state.poses.size(); ++j)
    if (j != i && state.placed[j] && !jointed(task.scene, i, j))
      visit(j, separation(bodies[i].shape, pose, bodies[j].shape, state.poses[j]));
}

}  // namespace

std::optional<std::size_t> blocker(const Task& task, const PartialState& state, std::size_t i,
                                   const Pose& pose) {
  std::optional<std::size_t> first;
  for_placed(task, state, i, pose, [&](std::size_t j, double gap) {
    if (!first && gap < kClearance - kSlideError) first = j;
  });
  return first;
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
    double free = std::numeric_limits<double>::infinity();
    for_placed(task, state, i, pose,
               [&](std::size_t, double gap) { free = std::min(free, gap - approach.gap); });
    if (free < kSlideError) return free > -kSlideError ? std::optional(pose) : std::nullopt;
    pose.x += free * approach.heading.x();
    pose.y += free * approach.heading.y();
    gone += free;
  }
  return std::nullopt;
}

}  // namespace rtg::tasks

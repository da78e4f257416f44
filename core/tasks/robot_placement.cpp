#include "core/tasks/robot_placement.hpp"

#include <optional>

namespace rtg::tasks {
namespace {

constexpr double kBehindShare = 0.75;  // probability that the robot stands as after a push
constexpr double kBehindGap = 0.03;    // robot as after a push: largest gap above kClearance [m]
constexpr double kFreeRange = 3.0;     // otherwise: largest offset from a body in x and in y [m]

std::size_t any_object(const GoalDraw& draw) {
  return static_cast<std::size_t>(1 + draw.rng.below(static_cast<int>(draw.task.scene.size()) - 1));
}

/// Draws a pose of the robot as after a push: it slides along a random heading towards a random
/// body until it meets a body. Returns nothing if it meets none.
std::optional<Pose> behind_a_body(GoalDraw& draw) {
  const Scene& scene = draw.task.scene;
  const PushConfig& push = draw.task.push;
  const std::size_t j = any_object(draw);
  const Vector2d d = direction(draw.rng.below(push.headings), push);
  const double span = scene.bodies[0].shape.radius() + scene.bodies[j].shape.radius();
  const Vector2d from = draw.state.poses[j].position() - (span + longest_stride(push)) * d +
                        draw.rng.uniform(-0.8, 0.8) * span * Vector2d(-d.y(), d.x());
  return slide(draw.task, draw.state, 0,
               {.from = {from.x(), from.y(), draw.task.start[0].theta},
                .heading = d,
                .gap = kClearance + draw.rng.uniform(0.0, kBehindGap),
                .range = 2.0 * (span + longest_stride(push))});
}

Pose near_a_body(GoalDraw& draw) {
  const Pose& near = draw.state.poses[any_object(draw)];
  const double x = near.x + draw.rng.uniform(-kFreeRange, kFreeRange);
  return {x, near.y + draw.rng.uniform(-kFreeRange, kFreeRange), draw.task.start[0].theta};
}

}  // namespace

bool place_robot(GoalDraw& draw) {
  const bool behind = draw.rng.uniform(0.0, 1.0) < kBehindShare;
  for (int k = 0; k < kProposals; ++k) {
    const std::optional<Pose> pose = behind ? behind_a_body(draw) : near_a_body(draw);
    if (!pose || !in_arena(*pose, draw.task.push)) continue;
    if (!is_clear(draw.task, draw.state, 0, *pose)) continue;
    draw.state.poses[0] = *pose;
    return true;
  }
  return false;
}

}  // namespace rtg::tasks

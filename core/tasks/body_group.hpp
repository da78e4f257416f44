#pragma once

#include <vector>

#include "core/tasks/goal_draw.hpp"

namespace rtg::tasks {

/// Bodies that are placed together, with their intended poses.
struct BodyGroup {
  std::size_t root;
  std::vector<std::size_t> members;  // root included
  Poses poses;                       // of all bodies
};

/// Returns the member by whose pose place_tree() positions the group: the one with the tightest
/// term of its own (a pose, else the narrowest region, else an angle), the root if there is none.
std::size_t positioned_member(const GoalDraw& draw, const BodyGroup& group);

/// Gives each joint of the group a random value that its limits and the goal allow. Returns false
/// if a joint has no such value.
bool draw_joint_values(GoalDraw& draw, BodyGroup& group);

/// Turns and moves the group as a rigid body until `member` has the pose `to`.
void move_to(BodyGroup& group, std::size_t member, const Pose& to);

/// For each term whose mean the group determines (determines_mean()), moves the group so that the
/// mean centre lies in the region.
void aim_at_means(GoalDraw& draw, BodyGroup& group);

/// Adds the bodies of `group` to the state if their poses are legal; returns whether they are. Each
/// movable body must meet the terms on it alone and lie in the arena. It must be clear of the
/// bodies placed before and of the rest of the group.
bool try_add(GoalDraw& draw, const BodyGroup& group);

}  // namespace rtg::tasks

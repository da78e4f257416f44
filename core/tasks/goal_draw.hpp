#pragma once

#include <vector>

#include "core/math/rng.hpp"
#include "core/tasks/placement.hpp"
#include "core/tasks/refusals.hpp"
#include "core/tasks/task.hpp"

namespace rtg::tasks {

inline constexpr int kProposals = 50;  // tries to place a body (or a tree of joints) in one attempt

/// A goal state that is being sampled, with the goal as it is to hold: tightened().
struct GoalDraw {
  const Task& task;
  const std::vector<GoalTerm>& goal;
  Rng& rng;
  PartialState state;
  Refusals refusals = {};  // of the proposals for what is being placed
};

/// Returns whether a body meets the terms on it alone; counts the terms that fail.
bool meets_terms_of(GoalDraw& draw, std::size_t body, const Poses& poses);

/// Returns whether all other terms hold; counts those that do not.
bool meets_goal(GoalDraw& draw);

/// Returns a uniform point of the arena.
Vector2d point_in_arena(GoalDraw& draw);

/// Draws a pose of body `i` for the goal: a uniform point of the arena, moved into the regions for
/// the centre, and any angle; then what the other terms on the body ask for, one after another.
Pose pose_in_goal(GoalDraw& draw, std::size_t i);

}  // namespace rtg::tasks

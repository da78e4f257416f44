#pragma once

#include <string>
#include <vector>

#include "core/tasks/task.hpp"

namespace rtg::tasks {

/// What a picture shows of a goal term: an area of the plane.
struct GoalMark {
  std::string kind;            // of the bodies that the term is about
  std::vector<Vector2d> ring;  // [m]
  bool target = false;         // the area is the outline of a body where it is to lie
  bool negated = false;
};

/// Returns the marks of the goal: regions, outlines of target poses, discs in which bodies stay.
/// Half-planes are cut off beyond every window on the arena. Angles and distances have no mark.
std::vector<GoalMark> goal_marks(const Task& task);

}  // namespace rtg::tasks

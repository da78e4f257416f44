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

/// Returns the marks of the goal that stay where they are: regions, outlines of target poses (one
/// per shape of the bodies, and for `pose` the disc and the sector of its tolerances), discs in
/// which bodies stay. Half-planes are cut off beyond every window on the arena.
std::vector<GoalMark> goal_marks(const Task& task);

/// Returns the marks of the goal that go with the bodies at `poses`: of an angle, the sector of the
/// directions that the body's x axis may have, of all equal ones the one nearest to it; of
/// distances, the outlines of the other bodies, grown by the gap, which are negated where bodies
/// must keep out.
std::vector<GoalMark> body_marks(const Task& task, const Poses& poses);

/// Returns the marks of the goal terms on joints: outlines of the joint's child, with its parent at
/// `poses`, at values from the least to the most that both the term and the joint's limits allow.
/// The first and the last outline of each range are targets.
std::vector<GoalMark> joint_marks(const Task& task, const Poses& poses);

}  // namespace rtg::tasks

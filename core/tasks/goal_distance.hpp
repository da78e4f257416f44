#pragma once

#include "core/tasks/task.hpp"

namespace rtg::tasks {

/// Estimates how far a state is from success; 0 where the goal holds:
///
///   Σ_i v_i + w · min_b |x_robot - x_b|,   w = 0.2
///
/// i runs over the single conditions of the goal, one per body, joint or mean centre. v_i ≥ 0 is
/// how far the point [m] or angle [rad] of a condition lies outside its region: lengths in units of
/// the task (tasks::Units) and angles are added as they are, 1 rad like 1 m. b runs over the
/// bodies of conditions that do not hold. A joint contributes both of its bodies.
double goal_distance(const Task& task, const Poses& poses);

}  // namespace rtg::tasks

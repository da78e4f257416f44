#pragma once

#include "core/tasks/task.hpp"

namespace rtg::tasks {

/// Estimates how far a state is from success [m], [rad]; 0 where the goal holds:
///
///   Σ_atoms v + w · min_b |x_robot - x_b|,
///
/// where v is how far the point or angle of an atom of the goal lies outside its region (0 inside),
/// b runs over the bodies of the atoms that do not hold (both bodies of a joint), and w = 0.2.
double goal_distance(const Task& task, const Poses& poses);

}  // namespace rtg::tasks

#pragma once

#include "core/tasks/task.hpp"

namespace rtg::tasks {

/// Estimates how far a state is from success [m], [rad]; 0 where the goal holds:
///
///   Σ_atoms v + w · min_b |x_robot - x_b|,
///
/// v how far the point or angle of an atom of the goal lies outside of its region, b the bodies of
/// atoms that do not hold (of a joint the two that it connects), w = 0.2.
double goal_distance(const Task& task, const Poses& poses);

}  // namespace rtg::tasks

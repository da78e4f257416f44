#pragma once

#include "core/math/rng.hpp"
#include "core/tasks/task.hpp"

namespace rtg::tasks {

/// Draws an action (index of a heading) that is likely to move an object. It is the one that points
/// closest to a random point in the bounding circle of a random movable object. With uniform
/// headings, only one push in ten moves an object.
int contact_heading(const Task& task, const Poses& state, Rng& rng);

}  // namespace rtg::tasks

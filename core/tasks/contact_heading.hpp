#pragma once

#include "core/math/rng.hpp"
#include "core/tasks/task.hpp"

namespace rtg::tasks {

/// A heading that seeks contact: the one that points closest to a random point of the bounding
/// circle of a random movable object. Of uniform pushes one in ten moves anything.
int contact_heading(const Task& task, const Poses& state, Rng& rng);

}  // namespace rtg::tasks

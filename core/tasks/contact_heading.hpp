#pragma once

#include "core/math/rng.hpp"
#include "core/tasks/task.hpp"

namespace rtg::tasks {

/// Draws a heading that seeks contact: the heading that points closest to a random point within the
/// bounding circle of a random movable object. Of pushes with uniform headings, only one in ten
/// moves an object.
int contact_heading(const Task& task, const Poses& state, Rng& rng);

}  // namespace rtg::tasks

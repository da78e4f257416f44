#pragma once

#include "core/tasks/task.hpp"

namespace rtg {

/// Gathering: push three scattered boxes together, all centres within 2 m of the
/// origin. A random policy never gets there; 11 pushes suffice.
Task gathering();

/// The same with a fourth box; 13 pushes suffice.
Task gathering_hard();

}  // namespace rtg

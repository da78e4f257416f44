#pragma once

#include <optional>

#include "core/math/rng.hpp"
#include "core/tasks/refusals.hpp"
#include "core/tasks/task.hpp"

namespace rtg::tasks {

/// Draws a state that satisfies the tightened() goal. It places, in this order:
///
///   - each object where the terms on it ask for, at a random angle unless they tell one, or beside
///     a placed body. Jointed bodies move as one: the one with the tightest term to its place, or
///     one that is to touch another until it does. The last body of a term with a mean goes where
///     that fits. All other terms are tested.
///   - the robot, with its angle of `task.start`: just behind a body as after a push (3 of 4
///     draws), or near a body but clear of all.
///
/// Fixed bodies stay; all others are in the arena. Poses are rounded by to_single(). The state is
/// only nearly at rest, so callers must let it settle. Returns nothing if 1000 attempts fail. Adds
/// to `refusals`, if not null.
std::optional<Poses> sample_goal(const Task& task, Rng& rng, Refusals* refusals = nullptr);

}  // namespace rtg::tasks

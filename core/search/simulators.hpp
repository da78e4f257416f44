#pragma once

#include "core/reverse/problem/reverse_config.hpp"
#include "core/search/seams.hpp"
#include "core/search/search_config.hpp"
#include "core/tasks/task.hpp"
#include "core/world/physics_config.hpp"

namespace rtg::search {

/// The reverse simulator behind `generator`: NaiveReverse for kNaive, else RRBS; pure, and callable
/// from several threads at once.
SolveBatch reverse_solver(const tasks::Task& task, const PhysicsConfig& physics,
                          const reverse::ReverseConfig& reverse, Generator generator);

/// The true dynamics, Box2D; kSettle is answered, too.
ReplayOne forward_replay(const tasks::Task& task, const PhysicsConfig& physics);

/// The seams with all simulators on `threads` threads of this process; store, progress and
/// cancelled are left to the caller.
GenerationSeams in_process_seams(SolveBatch solve, ReplayOne replay, int threads);

}  // namespace rtg::search

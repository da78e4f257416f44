#pragma once

#include "core/forward/forward_config.hpp"
#include "core/reverse/problem/reverse_config.hpp"
#include "core/search/seams.hpp"
#include "core/search/search_config.hpp"
#include "core/tasks/task.hpp"
#include "core/world/physics_config.hpp"

namespace rtg::search {

/// Returns the reverse simulator of `generator`: NaiveReverse for kNaive, else ReverseSimulator. It
/// is pure and safe to call from several threads at once.
SolveBatch reverse_solver(const tasks::Task& task, const PhysicsConfig& physics,
                          const reverse::ReverseConfig& reverse, Generator generator);

/// Returns the simulator of the true dynamics. It also answers jobs with action kSettle.
ReplayOne forward_replay(const tasks::Task& task, const PhysicsConfig& physics,
                         const forward::ForwardConfig& forward = {});

/// Returns seams whose `solve` and `replay` use `threads` threads of this process. The caller sets
/// `store`, and may set `progress` and `cancelled`.
GenerationSeams in_process_seams(SolveBatch solve, ReplayOne replay, int threads);

}  // namespace rtg::search

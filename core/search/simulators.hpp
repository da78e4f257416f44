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

/// Return functions that spread a batch of jobs over `threads` threads of this process. `solve`
/// answers several jobs per call, `replay` a single one. Both must be pure and safe to call from
/// several threads at once. The results are in job order, with `cpu_s` set. Jobs solved in one call
/// get equal shares of its CPU time.
SolveBatch solve_on_threads(SolveBatch solve, int threads);
ReplayBatch replay_on_threads(ReplayOne replay, int threads);

/// Returns seams with the paces of the task, whose `solve` is reverse_solver() on `threads` threads
/// of this process. The caller sets `store`, and may set `progress` and `cancelled`.
GenerationSeams in_process_seams(const tasks::Task& task, const PhysicsConfig& physics,
                                 const reverse::ReverseConfig& reverse, Generator generator,
                                 int threads, ReplayBatch replay);

}  // namespace rtg::search

#pragma once

#include <cstddef>
#include <functional>

#include "core/search/batches.hpp"

namespace rtg {

/// Calls work(0), ..., work(count-1) on up to `threads` threads (≥ 1), each index once. If calls
/// throw, the exception of the least index is rethrown here after all threads have stopped; indices
/// not yet begun by then may be skipped.
void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t)>& work);

/// CPU time the calling thread has used so far [s].
double thread_cpu_s();

/// The same of all threads of the process, those that have ended, too [s].
double process_cpu_s();

/// The in-process homes of the two seams: jobs are answered by `solve`, some at a time, and one by
/// one by `replay`, which must be pure and callable from several threads at once. Results come in
/// job order, with cpu_s filled in: of jobs answered together each has an equal share.
SolveBatch solve_on_threads(SolveBatch solve, int threads);
ReplayBatch replay_on_threads(std::function<ReplayResult(const ReplayJob&)> replay, int threads);

}  // namespace rtg

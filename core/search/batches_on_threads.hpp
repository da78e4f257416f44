#pragma once

#include <functional>

#include "core/search/batches.hpp"

namespace rtg {

/// The in-process homes of the two seams: jobs are answered by `solve`, some at a time, and one by
/// one by `replay`, which must be pure and callable from several threads at once. Results come in
/// job order, with cpu_s filled in: of jobs answered together each has an equal share.
SolveBatch solve_on_threads(SolveBatch solve, int threads);
ReplayBatch replay_on_threads(std::function<ReplayResult(const ReplayJob&)> replay, int threads);

}  // namespace rtg

#pragma once

#include "core/search/seams.hpp"

namespace rtg::search {

/// The in-process homes of the two seams: jobs are answered by `solve`, some at a time, and one by
/// one by `replay`; both must be pure and callable from several threads at once. Results come in
/// job order, with cpu_s filled in: of jobs answered together each has an equal share.
SolveBatch solve_on_threads(SolveBatch solve, int threads);
ReplayBatch replay_on_threads(ReplayOne replay, int threads);

}  // namespace rtg::search

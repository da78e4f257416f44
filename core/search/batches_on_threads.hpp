#pragma once

#include "core/search/seams.hpp"

namespace rtg::search {

/// Return implementations of the two seams on threads of this process. `solve` answers several jobs
/// at a time, `replay` a single one; both must be pure and safe to call from several threads at
/// once. The results are in job order, with cpu_s filled in; jobs answered together get equal
/// shares of their CPU time.
SolveBatch solve_on_threads(SolveBatch solve, int threads);
ReplayBatch replay_on_threads(ReplayOne replay, int threads);

}  // namespace rtg::search

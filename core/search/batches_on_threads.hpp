#pragma once

#include "core/search/seams.hpp"

namespace rtg::search {

/// Return functions that spread a batch of jobs over `threads` threads of this process. `solve`
/// answers several jobs per call, `replay` a single one. Both must be pure and safe to call from
/// several threads at once. The results are in job order, with `cpu_s` set. Jobs solved in one call
/// get equal shares of its CPU time.
SolveBatch solve_on_threads(SolveBatch solve, int threads);
ReplayBatch replay_on_threads(ReplayOne replay, int threads);

}  // namespace rtg::search

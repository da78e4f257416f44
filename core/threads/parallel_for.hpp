#pragma once

#include <cstddef>
#include <functional>

namespace rtg::threads {

/// Calls work(0), ..., work(count-1), once each, on up to `threads` threads (≥ 1). Rethrows the
/// exception of the least index whose call threw, after all threads have stopped. Calls that have
/// not begun when one throws may be skipped.
void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t)>& work);

}  // namespace rtg::threads

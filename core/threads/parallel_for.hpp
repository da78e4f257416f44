#pragma once

#include <cstddef>
#include <functional>

namespace rtg::threads {

/// Calls work(0), ..., work(count-1) on up to `threads` threads (≥ 1), each index once. If calls
/// throw, the exception of the least index is rethrown here after all threads have stopped; indices
/// not yet begun by then may be skipped.
void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t)>& work);

}  // namespace rtg::threads

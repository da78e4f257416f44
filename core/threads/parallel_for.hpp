#pragma once

#include <cstddef>
#include <functional>

namespace rtg::threads {

/// Calls work(0), ..., work(count-1), once each, on up to `threads` threads (≥ 1). If a call
/// throws, indices that have not begun by then may be skipped. After all threads have stopped,
/// parallel_for() rethrows the exception of the least index.
void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t)>& work);

}  // namespace rtg::threads

#include "core/threads/parallel_for.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace rtg::threads {
namespace {

/// Keeps the exception of the least index. record() is thread-safe.
class FirstError {
 public:
  void record(std::size_t index, std::exception_ptr error) {
    const std::lock_guard lock(mutex_);
    if (error_ && index_ <= index) return;
    index_ = index;
    error_ = std::move(error);
  }
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  std::mutex mutex_;
  std::size_t index_ = 0;
  std::exception_ptr error_;
};

}  // namespace

void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next{0};
  std::atomic<bool> stop{false};
  FirstError error;
  const auto run = [&] {
    // Threads take the indices in ascending order and finish each index that they take. So if index
    // k fails, all lesser indices are processed, too. The least failing index is therefore known.
    while (!stop) {
      const std::size_t k = next++;
      if (k >= count) return;
      try {
        work(k);
      } catch (...) {
        error.record(k, std::current_exception());
        stop = true;
      }
    }
  };
  {
    std::vector<std::jthread> helpers;
    const std::size_t wanted = std::min<std::size_t>(count, std::max(threads, 1));
    for (std::size_t k = 1; k < wanted; ++k) helpers.emplace_back(run);
    run();
  }
  error.rethrow();
}

}  // namespace rtg::threads

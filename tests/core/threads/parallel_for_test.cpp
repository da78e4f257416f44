#include "core/threads/parallel_for.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <string>
#include <vector>

namespace rtg::threads {
namespace {

TEST(ParallelFor, CallsEveryIndexOnce) {
  for (int threads = 1; threads <= 8; ++threads)
    for (const std::size_t count : {0U, 1U, 3U, 8U, 1000U}) {
      std::vector<std::atomic<int>> calls(count);
      parallel_for(count, threads, [&](std::size_t k) { ++calls.at(k); });
      for (const std::atomic<int>& c : calls) ASSERT_EQ(c, 1);
    }
}

TEST(ParallelFor, OneThreadIsTheCaller) {
  std::vector<std::size_t> order;  // not guarded
  parallel_for(100, 1, [&](std::size_t k) { order.push_back(k); });
  ASSERT_EQ(order.size(), 100U);
  for (std::size_t k = 0; k < order.size(); ++k) EXPECT_EQ(order[k], k);
}

/// Returns what parallel_for throws if the calls from `first` on throw their index.
std::string thrown(std::size_t count, int threads, std::size_t first) {
  try {
    parallel_for(count, threads, [first](std::size_t k) {
      if (k >= first) throw std::runtime_error(std::to_string(k));
    });
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "nothing";
}

TEST(ParallelFor, RethrowsTheExceptionOfTheLeastIndex) {
  for (int threads = 1; threads <= 8; ++threads) {
    EXPECT_EQ(thrown(20, threads, 20), "nothing");
    for (int run = 0; run < 500; ++run) ASSERT_EQ(thrown(20, threads, 3), "3") << threads;
  }
}

TEST(ParallelFor, AllCallsHaveReturnedWhenItThrows) {
  std::atomic<int> running{0};
  const auto work = [&](std::size_t k) {
    ++running;
    for (std::atomic<int> busy{0}; busy < 1000;) ++busy;
    --running;
    if (k == 5) throw std::runtime_error("");
  };
  for (int run = 0; run < 50; ++run) {
    EXPECT_THROW(parallel_for(10000, 4, work), std::runtime_error);
    ASSERT_EQ(running, 0);
  }
}

}  // namespace
}  // namespace rtg::threads

#include "core/threads/cpu_clock.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace rtg::threads {
namespace {

constexpr double kWork = 0.05;  // CPU time [s]

/// Keeps the calling thread busy until it has used kWork; false if the clock stands.
bool work() {
  const double begin = thread_cpu_s();
  for (long k = 0; k < 100'000'000; ++k)
    if (thread_cpu_s() - begin >= kWork) return true;
  return false;
}

TEST(CpuClock, IsThatOfTheCallingThreadOrOfAll) {
  const double before = thread_cpu_s(), all_before = process_cpu_s();
  bool worked = false;
  std::jthread([&worked] { worked = work(); }).join();
  EXPECT_TRUE(worked);
  EXPECT_LT(thread_cpu_s() - before, kWork);
  EXPECT_GE(process_cpu_s() - all_before, kWork);  // threads that have ended are counted
}

}  // namespace
}  // namespace rtg::threads

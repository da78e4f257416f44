#include "core/threads/cpu_clock.hpp"

#include <time.h>

namespace rtg::threads {
namespace {

double seconds(clockid_t clock) {
  timespec used{};
  clock_gettime(clock, &used);
  return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
}

}  // namespace

double thread_cpu_s() { return seconds(CLOCK_THREAD_CPUTIME_ID); }

double process_cpu_s() { return seconds(CLOCK_PROCESS_CPUTIME_ID); }

}  // namespace rtg::threads

#include <unistd.h>

namespace {

/// Ends the program with status 2, before it does anything else, on a processor that lacks
/// instructions for which all other files are compiled. This one is compiled for any, so it must
/// not include others of ours: the linker might use their functions from here.
[[gnu::constructor(101)]] void check_processor() {
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi2") &&
      __builtin_cpu_supports("fma"))
    return;
  static constexpr char kText[] =
      "rtg: this processor lacks avx2, bmi2 or fma; legal: an x86-64-v3 processor, as most are "
      "since 2013\n";
  static_cast<void>(!write(STDERR_FILENO, kText, sizeof kText - 1));
  _exit(2);
}

}  // namespace

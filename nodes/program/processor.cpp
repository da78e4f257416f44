#include <unistd.h>

namespace {

/// Ends the program, before it does anything else, on a processor that lacks instructions for which
/// all other files are compiled. This one is compiled for any, so it must not include others of
/// ours: the linker might use their functions from here.
[[gnu::constructor(101)]] void check_processor() {
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi2") &&
      __builtin_cpu_supports("fma"))
    return;
  static constexpr char kText[] =
      "rtg: compiled for processors with avx2, bmi2 and fma (x86-64-v3), and this one lacks some; "
      "legal: a build for any, with cmake -DRTG_PROCESSOR=x86-64, which gives the same transitions "
      "slowly\n";
  static_cast<void>(!write(STDERR_FILENO, kText, sizeof kText - 1));
  _exit(1);
}

}  // namespace

#pragma once

#include <cstdint>
#include <random>

namespace rtg {

/// Deterministic random stream: the same seed gives the same numbers in every process.
///
/// The standard specifies the bits of std::mt19937_64, but not how std::uniform_real_distribution
/// maps them to reals. This class therefore maps them itself.
class Rng {
 public:
  explicit Rng(std::uint64_t seed) : engine_(mix(seed)) {}

  /// Makes the stream of a sub-task, which depends on (`seed`, `key`) alone. Streams of different
  /// keys are independent.
  Rng(std::uint64_t seed, std::uint64_t key)
      : engine_(mix(mix(seed) ^ (key + 0x9e3779b97f4a7c15))) {}

  /// Draws a number, uniform in [lo, hi).
  double uniform(double lo, double hi) {
    return lo + (hi - lo) * static_cast<double>(engine_() >> 11) * 0x1.0p-53;
  }

  /// Draws 64 random bits, for seeding another stream.
  std::uint64_t word() { return engine_(); }

  /// Draws an integer, uniform in {0, ..., n-1}; n ≥ 1.
  int below(int n) { return static_cast<int>(uniform(0.0, static_cast<double>(n))); }

 private:
  static std::uint64_t mix(std::uint64_t x) {  // splitmix64 finaliser [Steele et al. 2014]
    x += 0x9e3779b97f4a7c15;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
    x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
    return x ^ (x >> 31);
  }

  std::mt19937_64 engine_;
};

}  // namespace rtg

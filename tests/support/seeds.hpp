#pragma once

#include <cstdint>
#include <cstdlib>
#include <numeric>
#include <string>
#include <vector>

namespace rtg::testing {

/// Returns the seeds of simulations 0 ... count - 1, or the one in the environment variable
/// RTG_SEED. Under sanitizers, which are some twenty times slower, only the first tenth of them.
inline std::vector<std::uint64_t> seeds(std::size_t count) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  count = (count + 9) / 10;
#endif
  if (const char* one = std::getenv("RTG_SEED")) return {std::stoull(one)};
  std::vector<std::uint64_t> all(count);
  std::iota(all.begin(), all.end(), 0);
  return all;
}

/// Returns how to run the simulation of a seed alone, for messages.
inline std::string replay(std::uint64_t seed) {
  return "to run it alone: RTG_SEED=" + std::to_string(seed);
}

}  // namespace rtg::testing

#pragma once

#include <cstdint>

namespace rtg {

/// Returns `hash` with `word` folded in; one-to-one in each argument. Folding in the words of a
/// sequence one by one gives the same hash in every process. Two sequences of equal length have the
/// same hash for about one pair in 2⁶⁴. The draws of the naive reverse simulator depend on these
/// bits.
constexpr std::uint64_t hashed(std::uint64_t hash, std::uint64_t word) {
  hash = (hash ^ word) * 0x9e3779b97f4a7c15;  // 2⁶⁴ / golden ratio
  return hash ^ (hash >> 32);  // low bits of a product do not depend on high bits of its factors
}

}  // namespace rtg

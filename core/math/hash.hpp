#pragma once

#include <cstdint>

namespace rtg {

/// Returns `hash` updated with `word`. The update is one-to-one in each argument. A sequence is
/// hashed by updating with its words one by one, with the same result in every process. Two
/// sequences of equal length collide with a probability of about 2⁻⁶⁴. The random draws of the
/// naive reverse simulator depend on these bits.
constexpr std::uint64_t hashed(std::uint64_t hash, std::uint64_t word) {
  hash = (hash ^ word) * 0x9e3779b97f4a7c15;  // 2⁶⁴ / golden ratio
  return hash ^ (hash >> 32);  // low bits of a product do not depend on high bits of its factors
}

}  // namespace rtg

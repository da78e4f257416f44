#pragma once

#include <cstdint>

namespace rtg {

/// `hash` with `word` folded in, one to one in either: a sequence of words folded in one by one has
/// the same name in every process, and another sequence of that length another, but for one pair in
/// 2⁶⁴. The draws of the naive reverse simulator hang on these bits.
constexpr std::uint64_t hashed(std::uint64_t hash, std::uint64_t word) {
  hash = (hash ^ word) * 0x9e3779b97f4a7c15;  // 2⁶⁴ / golden ratio
  return hash ^ (hash >> 32);                 // a product's low bits know nothing of the high ones
}

}  // namespace rtg

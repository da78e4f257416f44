#pragma once

#include <bit>
#include <cstdint>
#include <string_view>

#include "core/world/pose.hpp"

namespace rtg {

/// FNV-1a, 64 bit: names a text or a sequence of numbers the same way in every process and
/// language. Not a defence against forgers.
class ContentHash {
 public:
  ContentHash& add(std::string_view text) {
    for (const char c : text) byte(static_cast<std::uint8_t>(c));
    return *this;
  }

  /// Least significant byte first.
  ContentHash& add(std::uint64_t word) {
    for (int shift = 0; shift < 64; shift += 8) byte(static_cast<std::uint8_t>(word >> shift));
    return *this;
  }

  ContentHash& add(const Poses& poses) {
    for (const Pose& p : poses)
      for (const double x : {p.x, p.y, p.theta}) add(std::bit_cast<std::uint64_t>(x));
    return *this;
  }

  std::int64_t value() const { return static_cast<std::int64_t>(state_); }

 private:
  void byte(std::uint8_t b) { state_ = (state_ ^ b) * 0x100000001b3; }

  std::uint64_t state_ = 0xcbf29ce484222325;
};

}  // namespace rtg

#pragma once

#include <cstdint>
#include <string_view>

namespace rtg::bus {

/// 64-bit FNV-1a hash of a text, the same in every process and programming language. It is not
/// cryptographic and does not protect against forgery.
class ContentHash {
 public:
  ContentHash& add(std::string_view text) {
    for (const char c : text) byte(static_cast<std::uint8_t>(c));
    return *this;
  }

  std::int64_t value() const { return static_cast<std::int64_t>(state_); }

 private:
  void byte(std::uint8_t b) { state_ = (state_ ^ b) * 0x100000001b3; }

  std::uint64_t state_ = 0xcbf29ce484222325;
};

}  // namespace rtg::bus

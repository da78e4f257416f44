#pragma once

#include <sodium.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace rtg::files {

/// The SHA-256 (FIPS 180-4) of bytes that come one after another.
class Sha256 {
 public:
  static constexpr std::size_t kBytes = crypto_hash_sha256_BYTES;

  Sha256() { crypto_hash_sha256_init(&state_); }

  Sha256& add(std::span<const std::uint8_t> bytes);
  /// Return the digest of what has been added so far: its bytes, or as hexadecimal digits.
  std::array<std::uint8_t, kBytes> digest() const;
  std::string hex() const;

 private:
  crypto_hash_sha256_state state_;
};

}  // namespace rtg::files

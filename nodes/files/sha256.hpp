#pragma once

#include <sodium.h>

#include <cstdint>
#include <span>
#include <string>

namespace rtg::files {

/// The SHA-256 (FIPS 180-4) of bytes that come one after another.
class Sha256 {
 public:
  Sha256() { crypto_hash_sha256_init(&state_); }

  Sha256& add(std::span<const std::uint8_t> bytes);
  /// Returns the digest of what has been added so far, as 64 hexadecimal digits.
  std::string hex() const;

 private:
  crypto_hash_sha256_state state_;
};

}  // namespace rtg::files

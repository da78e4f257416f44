#include "nodes/files/sha256.hpp"

namespace rtg::files {

Sha256& Sha256::add(std::span<const std::uint8_t> bytes) {
  crypto_hash_sha256_update(&state_, bytes.data(), bytes.size());
  return *this;
}

std::array<std::uint8_t, Sha256::kBytes> Sha256::digest() const {
  crypto_hash_sha256_state state = state_;
  std::array<std::uint8_t, kBytes> digest{};
  crypto_hash_sha256_final(&state, digest.data());
  return digest;
}

std::string Sha256::hex() const {
  const auto bytes = digest();
  std::array<char, 2 * kBytes + 1> digits{};  // and a NUL
  sodium_bin2hex(digits.data(), digits.size(), bytes.data(), bytes.size());
  return digits.data();
}

}  // namespace rtg::files

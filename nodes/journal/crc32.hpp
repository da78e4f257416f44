#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace rtg::journal {

/// Returns the CRC-32 of IEEE 802.3, as zlib's crc32() does, of the bytes whose CRC-32 is `crc`
/// followed by `bytes`. It differs for any two texts that differ in at most 32 bits in a row.
constexpr std::uint32_t crc32(std::span<const std::uint8_t> bytes, std::uint32_t crc = 0) {
  constexpr std::array<std::uint32_t, 256> table = [] {
    std::array<std::uint32_t, 256> remainders{};
    for (std::uint32_t byte = 0; byte < 256; ++byte) {
      remainders[byte] = byte;
      for (int bit = 0; bit < 8; ++bit)
        remainders[byte] = remainders[byte] >> 1 ^ (remainders[byte] & 1 ? 0xedb88320 : 0);
    }
    return remainders;
  }();
  crc = ~crc;
  for (const std::uint8_t byte : bytes) crc = crc >> 8 ^ table[(crc ^ byte) & 0xff];
  return ~crc;
}

}  // namespace rtg::journal

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace rtg::journal {

/// crc32_tables()[k][b]: what byte b adds to the remainder of the k bytes behind it.
constexpr std::array<std::array<std::uint32_t, 256>, 8> crc32_tables() {
  std::array<std::array<std::uint32_t, 256>, 8> tables{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t& remainder = tables[0][byte] = byte;
    for (int bit = 0; bit < 8; ++bit) remainder = remainder >> 1 ^ (remainder & 1 ? 0xedb88320 : 0);
  }
  for (std::size_t k = 1; k < tables.size(); ++k)
    for (std::size_t byte = 0; byte < 256; ++byte) {
      const std::uint32_t before = tables[k - 1][byte];
      tables[k][byte] = before >> 8 ^ tables[0][before & 0xff];
    }
  return tables;
}

/// Returns the CRC-32 of IEEE 802.3, as zlib's crc32() does, of the bytes whose CRC-32 is `crc`
/// followed by `bytes`. It differs for any two texts of equal length that differ in at most 32 bits
/// in a row. Takes eight bytes at a time (Kounavis & Berry 2008).
inline std::uint32_t crc32(std::span<const std::uint8_t> bytes, std::uint32_t crc = 0) {
  static constexpr auto tables = crc32_tables();
  crc = ~crc;
  for (; bytes.size() >= 8; bytes = bytes.subspan(8)) {
    std::uint32_t sum = 0;
    for (std::size_t k = 0; k < 8; ++k) {
      const std::uint32_t carried = k < 4 ? crc >> 8 * k : 0;
      sum ^= tables[7 - k][(bytes[k] ^ carried) & 0xff];
    }
    crc = sum;
  }
  for (const std::uint8_t byte : bytes) crc = crc >> 8 ^ tables[0][(crc ^ byte) & 0xff];
  return ~crc;
}

}  // namespace rtg::journal

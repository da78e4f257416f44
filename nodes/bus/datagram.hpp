#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace rtg::bus {

/// A message as LCM sends it in one UDP datagram.
struct Datagram {
  std::string_view channel;
  std::span<const std::uint8_t> payload;
};

/// Splits the bytes of a datagram: "LC02", a sequence number of 4 bytes, the channel, a NUL, the
/// payload. Returns nothing for any other bytes, among them LCM's fragments of longer messages
/// ("LC03") and channels that are empty, longer than LCM's 63 bytes or not printable ASCII.
std::optional<Datagram> parse_datagram(std::span<const std::uint8_t> bytes);

}  // namespace rtg::bus

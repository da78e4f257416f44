#include "nodes/bus/datagram.hpp"

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace rtg::bus {
namespace {

constexpr std::string_view kMagic = "LC02";
constexpr std::size_t kHeaderBytes = 8;
constexpr std::size_t kLongestChannel = 63;

bool is_printable(char c) { return '!' <= c && c <= '~'; }

}  // namespace

std::optional<Datagram> parse_datagram(std::span<const std::uint8_t> bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (text.size() < kHeaderBytes || !text.starts_with(kMagic)) return std::nullopt;
  const std::string_view rest = text.substr(kHeaderBytes);
  const std::string_view channel = rest.substr(0, rest.substr(0, kLongestChannel + 1).find('\0'));
  if (channel.empty() || channel.size() > kLongestChannel || channel.size() == rest.size() ||
      !std::ranges::all_of(channel, is_printable))
    return std::nullopt;
  return Datagram{channel, bytes.subspan(kHeaderBytes + channel.size() + 1)};
}

}  // namespace rtg::bus

#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace rtg::bus {

/// Where the messages of a run go and come from.
struct BusUrl {
  bool in_process = false;  // "memq://": messages stay in the Bus object; for tests
  std::string group;        // multicast group
  std::uint16_t port = 0;
  int ttl = 0;                     // 0 keeps messages on this machine
  std::vector<std::string> peers;  // addresses of other machines whose messages are heard

  bool operator==(const BusUrl&) const = default;
};

/// Parses "udpm://GROUP:PORT[?ttl=N][&peers=ADDRESS,ADDRESS...]" or "memq://". Throws
/// std::invalid_argument if `url` is neither.
BusUrl parse_bus_url(const std::string& url);

}  // namespace rtg::bus

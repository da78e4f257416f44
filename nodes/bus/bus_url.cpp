#include "nodes/bus/bus_url.hpp"

#include <charconv>
#include <stdexcept>
#include <string_view>

namespace rtg::bus {
namespace {

/// Removes the prefix `word` from `text`. Returns whether `text` began with `word`.
bool take(std::string_view& text, std::string_view word) {
  if (!text.starts_with(word)) return false;
  text.remove_prefix(word.size());
  return true;
}

/// Removes a decimal number in [low, high] from the beginning of `text` into `value`. Returns
/// whether `text` began with one. Rejects leading zeros, because inet_aton() reads such numbers as
/// octal.
bool take_number(std::string_view& text, int low, int high, int& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && low <= value && value <= high && take(text, std::to_string(value));
}

/// Removes an IPv4 address whose first number is in [low, high] into `address`.
bool take_address(std::string_view& text, int low, int high, std::string& address) {
  const std::string_view before = text;
  int number = 0;
  if (!take_number(text, low, high, number)) return false;
  for (int byte = 1; byte < 4; ++byte)
    if (!take(text, ".") || !take_number(text, 0, 255, number)) return false;
  address = before.substr(0, before.size() - text.size());
  return true;
}

bool take_peers(std::string_view& text, std::vector<std::string>& peers) {
  do
    if (!take_address(text, 1, 223, peers.emplace_back())) return false;
  while (take(text, ","));
  return true;
}

bool take_url(std::string_view& text, BusUrl& url) {
  int port = 0;
  if (!take(text, "udpm://") || !take_address(text, 224, 239, url.group) || !take(text, ":") ||
      !take_number(text, 1024, 65535, port))
    return false;
  url.port = static_cast<std::uint16_t>(port);
  std::string_view before = "?";
  if (take(text, "?ttl=")) {
    if (!take_number(text, 0, 255, url.ttl)) return false;
    before = "&";
  }
  if (take(text, std::string(before) + "peers=")) return take_peers(text, url.peers);
  return true;
}

}  // namespace

BusUrl parse_bus_url(const std::string& url) {
  std::string_view rest = url;
  BusUrl parsed;
  parsed.in_process = url == "memq://";
  if (parsed.in_process) return parsed;
  if (!take_url(rest, parsed) || !rest.empty())
    throw std::invalid_argument(
        "'" + url +
        "' is not a bus URL; legal: memq://, udpm://GROUP:PORT[?ttl=N][&peers=ADDRESS,...] with a "
        "multicast group 224.x.x.x-239.x.x.x, port 1024-65535, ttl 0-255, IPv4 addresses");
  return parsed;
}

}  // namespace rtg::bus

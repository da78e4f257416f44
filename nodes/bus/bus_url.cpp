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

/// Removes a decimal number in [low, high] from the beginning of `text`. Returns whether `text`
/// began with one. Rejects leading zeros, because inet_aton() reads such numbers as octal.
bool take_number(std::string_view& text, int low, int high) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && low <= value && value <= high && take(text, std::to_string(value));
}

}  // namespace

std::string checked_bus_url(const std::string& url) {
  if (url == "memq://") return url;
  std::string_view rest = url;
  bool legal = take(rest, "udpm://") && take_number(rest, 224, 239);
  for (int byte = 1; byte < 4; ++byte)
    legal = legal && take(rest, ".") && take_number(rest, 0, 255);
  legal = legal && take(rest, ":") && take_number(rest, 1024, 65535);
  const bool has_ttl = take(rest, "?ttl=");
  legal = legal && (!has_ttl || take_number(rest, 0, 255)) && rest.empty();
  if (!legal)
    throw std::invalid_argument(
        "'" + url +
        "' is not a bus URL; legal: memq://, udpm://GROUP:PORT[?ttl=N] with a multicast group "
        "224.x.x.x-239.x.x.x, port 1024-65535, ttl 0-255");
  return url + (has_ttl ? "&" : "?ttl=0&") + "recv_buf_size=" + std::to_string(kReceiveBuffer);
}

}  // namespace rtg::bus

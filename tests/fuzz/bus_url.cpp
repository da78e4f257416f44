// The text of a bus URL, as the configuration and flags give it.
#include "nodes/bus/bus_url.hpp"

#include <arpa/inet.h>

#include <stdexcept>

#include "tests/fuzz/target.hpp"

namespace rtg::fuzz {
namespace {

bool is_address(const std::string& text) {
  in_addr address{};
  return inet_pton(AF_INET, text.c_str(), &address) == 1;
}

void check(const std::string& text) {
  const bus::BusUrl url = bus::parse_bus_url(text);
  if (url.in_process) return;
  require(is_address(url.group), "the group is an address");
  require(url.port >= 1024 && url.ttl >= 0 && url.ttl <= 255, "port and ttl are in their ranges");
  for (const std::string& peer : url.peers) require(is_address(peer), "a peer is an address");
  require(text.starts_with("udpm://" + url.group + ":" + std::to_string(url.port)),
          "group and port are those of the text");
}

}  // namespace

std::vector<Bytes> seeds() {
  return {bytes_of("memq://"), bytes_of("udpm://239.255.76.67:7667?ttl=1"),
          bytes_of("udpm://224.0.0.1:1024?peers=10.0.0.1"),
          bytes_of("udpm://239.255.76.67:65535?ttl=255&peers=10.0.0.1,192.168.178.20")};
}

}  // namespace rtg::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    rtg::fuzz::check({reinterpret_cast<const char*>(data), size});
  } catch (const std::invalid_argument&) {
  }
  return 0;
}

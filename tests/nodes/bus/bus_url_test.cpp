#include "nodes/bus/bus_url.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace rtg::bus {
namespace {

TEST(BusUrl, HasAGroupAPortAndWhoIsHeard) {
  BusUrl url;
  url.group = "239.255.76.67";
  url.port = 7667;
  EXPECT_EQ(parse_bus_url("udpm://239.255.76.67:7667"), url);
  EXPECT_EQ(parse_bus_url("udpm://239.255.76.67:7667?ttl=0"), url);
  BusUrl other = url;
  other.peers = {"10.0.0.2", "192.168.1.30"};
  EXPECT_EQ(parse_bus_url("udpm://239.255.76.67:7667?peers=10.0.0.2,192.168.1.30"), other);
  other.ttl = 1;
  EXPECT_EQ(parse_bus_url("udpm://239.255.76.67:7667?ttl=1&peers=10.0.0.2,192.168.1.30"), other);
  BusUrl local;
  local.in_process = true;
  EXPECT_EQ(parse_bus_url("memq://"), local);
}

TEST(BusUrl, IllegalOnesAreNamed) {
  const std::string legal =
      "' is not a bus URL; legal: memq://, udpm://GROUP:PORT[?ttl=N][&peers=ADDRESS,...] with a "
      "multicast group 224.x.x.x-239.x.x.x, port 1024-65535, ttl 0-255, IPv4 addresses";
  for (const std::string url :
       {"", "udpm://", "tcpq://127.0.0.1:7700", "udpm://10.0.0.1:7667", "udpm://239.255.76.67",
        "udpm://239.255.76.67:80", "udpm://239.255.76.67:70000", "udpm://239.255.76.67:7667?ttl=-1",
        "udpm://239.255.76.67:7667?ttl=300", "udpm://239.255.76.67:7667?ttl=1&a=b",
        "udpm://239.255.076.67:7667", "udpm://239.255.-0.67:7667",
        "udpm://239.99999999999.1.1:7667",
        "udpm://239.255.76.67:7667?peers=", "udpm://239.255.76.67:7667?peers=10.0.0.2,",
        "udpm://239.255.76.67:7667&peers=10.0.0.2", "udpm://239.255.76.67:7667?peers=239.0.0.1",
        "udpm://239.255.76.67:7667?ttl=1?peers=10.0.0.2"}) {
    try {
      (void)parse_bus_url(url);
      ADD_FAILURE() << url << " was accepted";
    } catch (const std::invalid_argument& error) {
      EXPECT_EQ(error.what(), "'" + url + legal);
    }
  }
}

}  // namespace
}  // namespace rtg::bus

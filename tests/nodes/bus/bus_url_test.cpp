#include "nodes/bus/bus_url.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace rtg::bus {
namespace {

TEST(BusUrl, IsSpeltOut) {
  EXPECT_EQ(checked_bus_url("udpm://239.255.76.67:7667"),
            "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304");
  EXPECT_EQ(checked_bus_url("udpm://239.255.76.67:7667?ttl=1"),
            "udpm://239.255.76.67:7667?ttl=1&recv_buf_size=4194304");
  EXPECT_EQ(checked_bus_url("memq://"), "memq://");
}

TEST(BusUrl, IllegalOnesAreNamed) {
  const std::string legal =
      "' is not a bus URL; legal: memq://, udpm://GROUP:PORT[?ttl=N] with a multicast group "
      "224.x.x.x-239.x.x.x, port 1024-65535, ttl 0-255";
  for (const std::string url :
       {"", "udpm://", "tcpq://127.0.0.1:7700", "udpm://10.0.0.1:7667", "udpm://239.255.76.67",
        "udpm://239.255.76.67:80", "udpm://239.255.76.67:70000", "udpm://239.255.76.67:7667?ttl=-1",
        "udpm://239.255.76.67:7667?ttl=300", "udpm://239.255.76.67:7667?ttl=1&a=b",
        "udpm://239.255.076.67:7667", "udpm://239.255.-0.67:7667",
        "udpm://239.99999999999.1.1:7667"}) {
    try {
      checked_bus_url(url);
      ADD_FAILURE() << url << " was accepted";
    } catch (const std::invalid_argument& error) {
      EXPECT_EQ(error.what(), "'" + url + legal);
    }
  }
}

}  // namespace
}  // namespace rtg::bus

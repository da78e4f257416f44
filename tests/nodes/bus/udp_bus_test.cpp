#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <cstdlib>

#include "nodes/bus/bus.hpp"
#include "nodes/files/descriptor.hpp"

namespace rtg::bus {
namespace {

using namespace std::chrono_literals;
using rtg_msgs::stream_tail_t;

const std::string kUrl = "udpm://239.255.76.67:7667";

void send_empty_datagram() {
  const files::Descriptor socket(::socket(AF_INET, SOCK_DGRAM, 0));
  sockaddr_in group{};
  group.sin_family = AF_INET;
  group.sin_addr.s_addr = inet_addr("239.255.76.67");
  group.sin_port = htons(7667);
  ASSERT_EQ(sendto(socket.number(), nullptr, 0, 0, reinterpret_cast<const sockaddr*>(&group),
                   sizeof group),
            0);
}

/// Runs in tests/support/private_network.sh alone: the machine's own network is none of our
/// business.
class UdpBus : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(std::getenv("RTG_PRIVATE_NETWORK")) << "see rtg_network_test()";
  }
};

TEST_F(UdpBus, DeliversToAnotherBusOfTheRun) {
  const RunKey key = RunKey::random("test");
  Bus sender(kUrl, key);
  Bus receiver(kUrl, key);
  Bus stranger(kUrl, RunKey::random("other"));
  std::vector<std::int64_t> counts;
  const auto handler = [&](const stream_tail_t& tail) { counts.push_back(tail.count); };
  receiver.subscribe<stream_tail_t>("TAIL", handler);
  stranger.subscribe<stream_tail_t>("TAIL", [](const stream_tail_t&) { FAIL(); });
  for (const int n : {1, 2, 3}) {
    stream_tail_t tail{};
    tail.count = n;
    sender.publish("TAIL", tail);
  }
  while (counts.size() < 3 && receiver.spin(10s) > 0) {
  }
  EXPECT_EQ(counts, (std::vector<std::int64_t>{1, 2, 3}));
  stranger.spin(0s);
  EXPECT_EQ(stranger.counters().all(), (std::map<std::string, long>{{"bus.foreign_run", 3}}));
}

TEST_F(UdpBus, CountsWhatItHadNoRoomForAndEmptyDatagrams) {
  const RunKey key = RunKey::random("test");
  Bus sender(kUrl, key);
  Bus receiver(kUrl, key);
  long heard = 0;
  receiver.subscribe<stream_tail_t>("TAIL", [&](const stream_tail_t&) { ++heard; });
  send_empty_datagram();
  constexpr long kMany = 40'000;  // more than the buffer holds
  for (long k = 0; k < kMany; ++k) sender.publish("TAIL", stream_tail_t{});
  while (receiver.spin(0s) > 0) {
  }
  sender.publish("TAIL", stream_tail_t{});  // with it the kernel tells of those before
  receiver.spin(10s);
  EXPECT_EQ(receiver.counters().value("bus.malformed"), 1);
  EXPECT_LT(heard, kMany);
  EXPECT_EQ(receiver.counters().value("bus.overflowed"), kMany + 1 - heard);
}

TEST_F(UdpBus, ANetworkThatSwallowsEverythingIsAnErrorThatSaysWhatToDo) {
  ASSERT_EQ(std::system("tc qdisc add dev lo root bfifo limit 1"), 0);
  try {
    Bus bus(kUrl, RunKey::random("test"));
    ADD_FAILURE() << "was accepted";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(
        error.what(),
        "bus: messages sent do not come back from multicast. To mend it: sudo ip link set lo "
        "multicast on && sudo ip route add 224.0.0.0/4 dev lo");
  }
  ASSERT_EQ(std::system("tc qdisc del dev lo root"), 0);
}

}  // namespace
}  // namespace rtg::bus

#include "nodes/bus/bus.hpp"

#include <gtest/gtest.h>

#include "tests/nodes/bus/filled_message.hpp"
#include "tests/nodes/bus/handle_all.hpp"

namespace rtg::bus {
namespace {

using namespace std::chrono_literals;
using rtg_msgs::stream_tail_t;

TEST(Bus, DeliversWhatWasPublished) {
  Bus bus("memq://", "test");
  std::vector<std::int64_t> counts;
  bus.subscribe<stream_tail_t>("TAIL",
                               [&](const stream_tail_t& tail) { counts.push_back(tail.count); });
  for (const int n : {1, 2, 3}) {
    auto tail = testing::filled<stream_tail_t>();
    tail.count = n;
    bus.publish("TAIL", tail);
  }
  testing::handle_all(bus);
  EXPECT_EQ(counts, (std::vector<std::int64_t>{1, 2, 3}));
}

// Waiting again would take the whole minute.
TEST(Bus, SpinWaitsForTheFirstMessageOnly) {
  Bus bus("memq://", "test");
  bus.subscribe<stream_tail_t>("TAIL", [](const stream_tail_t&) {});
  bus.publish("TAIL", stream_tail_t{});
  EXPECT_EQ(bus.spin(60s), 1);
}

TEST(Bus, ExceptionsOfHandlersSurfaceInSpinAndLoseNothing) {
  Bus bus("memq://", "test");
  int handled = 0;
  bus.subscribe<stream_tail_t>("TAIL", [&](const stream_tail_t&) {
    if (++handled == 1) throw std::range_error("boom");
  });
  bus.publish("TAIL", stream_tail_t{});
  bus.publish("TAIL", stream_tail_t{});
  EXPECT_THROW(bus.spin(0ms), std::range_error);
  testing::handle_all(bus);
  EXPECT_EQ(handled, 2);
}

/// Returns what a listening bus of the run "test" counts when a stranger sends `bytes`.
std::map<std::string, long> counters_after(std::span<const std::uint8_t> bytes) {
  Bus bus("memq://", "test");
  bus.subscribe<stream_tail_t>("TAIL", [](const stream_tail_t&) { FAIL(); });
  bus.send("TAIL", bytes);
  testing::handle_all(bus);
  return bus.counters().all();
}

using Counts = std::map<std::string, long>;

TEST(Bus, CountsWhatItRejects) {
  auto tail = testing::filled<stream_tail_t>();
  EXPECT_EQ(counters_after(encode(tail)), (Counts{{"bus.foreign_run", 1}}));

  auto other = testing::filled<rtg_msgs::worker_beat_t>();
  EXPECT_EQ(counters_after(encode(other)), (Counts{{"bus.wrong_type", 1}}));

  auto bytes = encode(tail);
  bytes.pop_back();
  EXPECT_EQ(counters_after(bytes), (Counts{{"bus.malformed", 1}}));

  bytes.assign(kMaxMessageBytes + 1, 0);
  EXPECT_EQ(counters_after(bytes), (Counts{{"bus.too_long", 1}}));
}

TEST(Bus, RejectsAnotherVersionOfTheProtocol) {
  Bus bus("memq://", "test");
  stream_tail_t tail;
  bus.subscribe<stream_tail_t>("TAIL", [&](const stream_tail_t& received) { tail = received; });
  bus.publish("TAIL", testing::filled<stream_tail_t>());
  testing::handle_all(bus);
  ++tail.header.protocol;  // all else is of the run "test"
  EXPECT_EQ(counters_after(encode(tail)), (Counts{{"bus.foreign_protocol", 1}}));
}

}  // namespace
}  // namespace rtg::bus

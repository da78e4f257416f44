#include "nodes/bus/bus.hpp"

#include <gtest/gtest.h>

#include "tests/nodes/bus/filled_message.hpp"
#include "tests/nodes/bus/handle_all.hpp"

namespace rtg::bus {
namespace {

using namespace std::chrono_literals;
using rtg_msgs::stream_tail_t;

TEST(Bus, DeliversWhatWasPublished) {
  Bus bus("memq://", RunKey::random("test"));
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

TEST(Bus, EveryHandlerOfAChannelGetsItsMessagesAndNoOther) {
  Bus bus("memq://", RunKey::random("test"));
  int first = 0, second = 0;
  bus.subscribe<stream_tail_t>("TAIL", [&](const stream_tail_t&) { ++first; });
  bus.subscribe<stream_tail_t>("TAIL", [&](const stream_tail_t&) { ++second; });
  bus.publish("TAIL", stream_tail_t{});
  bus.publish("ANOTHER", stream_tail_t{});
  EXPECT_EQ(bus.spin(0ms), 1);
  EXPECT_EQ(first, 1);
  EXPECT_EQ(second, 1);
  EXPECT_TRUE(bus.counters().all().empty());
}

// Waiting again would take the whole minute.
TEST(Bus, SpinWaitsForTheFirstMessageOnly) {
  Bus bus("memq://", RunKey::random("test"));
  bus.subscribe<stream_tail_t>("TAIL", [](const stream_tail_t&) {});
  bus.publish("TAIL", stream_tail_t{});
  EXPECT_EQ(bus.spin(60s), 1);
}

TEST(Bus, ExceptionsOfHandlersSurfaceInSpinAndLoseNothing) {
  Bus bus("memq://", RunKey::random("test"));
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

using Counts = std::map<std::string, long>;
using Bytes = std::vector<std::uint8_t>;

const RunKey kOurs = RunKey::random("test");

/// Returns what a listening bus with the key kOurs counts when somebody sends `bytes`.
Counts counters_after(std::span<const std::uint8_t> bytes) {
  Bus bus("memq://", kOurs);
  bus.subscribe<stream_tail_t>("TAIL", [](const stream_tail_t&) { FAIL(); });
  bus.send("TAIL", bytes);
  testing::handle_all(bus);
  return bus.counters().all();
}

/// Returns a message with the header of a run, as its processes encode it.
template <class Msg>
Bytes encoded(const RunKey& key, std::int32_t protocol = kProtocol) {
  auto message = testing::filled<Msg>();
  message.header.run = run_id(key.name());
  message.header.protocol = protocol;
  return encode(message);
}

Bytes sealed(const RunKey& key, Bytes bytes, const std::string& channel = "TAIL") {
  key.seal(channel, bytes);
  return bytes;
}

TEST(Bus, CountsWhatIsNotOfItsRun) {
  const RunKey other = RunKey::random("other"), namesake = RunKey::random("test");
  EXPECT_EQ(counters_after(sealed(other, encoded<stream_tail_t>(other))),
            (Counts{{"bus.foreign_run", 1}}));
  EXPECT_EQ(counters_after(sealed(namesake, encoded<stream_tail_t>(namesake))),
            (Counts{{"bus.forged", 1}}));
  EXPECT_EQ(counters_after(encoded<stream_tail_t>(kOurs)), (Counts{{"bus.forged", 1}}));
  EXPECT_EQ(counters_after(sealed(kOurs, encoded<stream_tail_t>(kOurs), "ACK")),
            (Counts{{"bus.forged", 1}}));
  EXPECT_EQ(counters_after(Bytes(7, 1)), (Counts{{"bus.foreign_run", 1}}));
}

// Even one who has the key, with another version of the program, does no harm.
TEST(Bus, CountsWhatItCannotRead) {
  EXPECT_EQ(counters_after(sealed(kOurs, encoded<stream_tail_t>(kOurs, kProtocol + 1))),
            (Counts{{"bus.foreign_protocol", 1}}));
  EXPECT_EQ(counters_after(sealed(kOurs, encoded<rtg_msgs::worker_beat_t>(kOurs))),
            (Counts{{"bus.wrong_type", 1}}));
  Bytes bytes = encoded<stream_tail_t>(kOurs);
  bytes.pop_back();
  EXPECT_EQ(counters_after(sealed(kOurs, bytes)), (Counts{{"bus.malformed", 1}}));
  bytes.resize(kMaxMessageBytes + 1);
  EXPECT_EQ(counters_after(sealed(kOurs, bytes)), (Counts{{"bus.too_long", 1}}));
}

TEST(Bus, AnyFlippedBitIsCountedAndNotHeard) {
  const Bytes right = sealed(kOurs, encoded<stream_tail_t>(kOurs));
  for (std::size_t bit = 0; bit < right.size() * 8; ++bit) {
    Bytes wrong = right;
    wrong[bit / 8] = static_cast<std::uint8_t>(wrong[bit / 8] ^ 1U << bit % 8);
    const Counts counts = counters_after(wrong);
    ASSERT_EQ(counts.size(), 1U) << bit;
  }
}

}  // namespace
}  // namespace rtg::bus

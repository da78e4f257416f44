#include "nodes/stream/stream_server.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace rtg::stream {
namespace {

using Ranges = std::vector<RowRange>;

constexpr std::int64_t kRowBytes = 100;  // hence 160 rows per message, 640 per burst

StreamServer server_with(int rows) {
  StreamServer server({}, kRowBytes);
  server.append(std::vector<search::Transition>(static_cast<std::size_t>(rows)));
  return server;
}

void ack(StreamServer& server, std::int64_t cursor, const Ranges& missing = {},
         bus::Seconds now = 0.0, std::int64_t credit = 100000) {
  EXPECT_TRUE(server.on_ack({7, cursor, credit, missing}, now));
}

TEST(StreamServer, SendsNewRowsOnceInMessagesOfBoundedSize) {
  StreamServer server = server_with(400);
  EXPECT_EQ(server.due(0.0), (Ranges{{0, 160}, {160, 320}, {320, 400}}));
  EXPECT_EQ(server.due(0.1), Ranges{});
  server.append(std::vector<search::Transition>(1));
  EXPECT_EQ(server.due(0.2), (Ranges{{400, 401}}));
}

TEST(StreamServer, ABurstIsNoLongerThanAReceiveBufferStands) {
  StreamServer server = server_with(100000);
  EXPECT_EQ(server.due(0.0).size(), 4u);  // 64 kB
  EXPECT_EQ(server.due(0.0).size(), 0u);
  EXPECT_EQ(server.due(0.001).size(), 1u);  // 10 kB on
}

TEST(StreamServer, SilenceBeforeABurstMakesItNoLonger) {
  StreamServer server({}, kRowBytes);
  server.due(0.0);
  server.append(std::vector<search::Transition>(100000));
  EXPECT_EQ(server.due(3600.0).size(), 4u);
}

TEST(StreamServer, RowsAskedForGoOutAgainAndFirst) {
  StreamServer server = server_with(400);
  server.due(0.0);
  server.append(std::vector<search::Transition>(10));
  ack(server, 20, {{20, 30}, {100, 300}, {25, 40}});
  EXPECT_EQ(server.due(1.0), (Ranges{{20, 40}, {100, 260}, {260, 300}, {400, 410}}));
  EXPECT_EQ(server.resent(), 220);
}

TEST(StreamServer, RowsThatWereNeverSentAreNotResent) {
  StreamServer server = server_with(1000);
  server.due(0.0);  // 640 rows
  ack(server, 600, {{600, 1000}});
  EXPECT_EQ(server.due(0.002), (Ranges{{600, 640}, {640, 800}}));
}

TEST(StreamServer, HostileRangesAreCutToWhatExists) {
  StreamServer server = server_with(100);
  server.due(0.0);
  constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();
  ack(server, 0, {{-most, most}, {most, -most}, {most - 1, most}, {50, 20}});
  EXPECT_EQ(server.due(1.0), (Ranges{{0, 100}}));
}

TEST(StreamServer, AnImpossibleCursorIsIgnored) {
  StreamServer server = server_with(100);
  EXPECT_FALSE(server.on_ack({7, 101, 10, {}}, 0.0));
  EXPECT_FALSE(server.on_ack({7, -1, 10, {}}, 0.0));
  EXPECT_FALSE(server.on_ack({7, 0, std::numeric_limits<std::int64_t>::max(), {}}, 0.0));
  EXPECT_EQ(server.consumers(), 0);
}

TEST(StreamServer, TheNumberOfConsumersIsBounded) {
  StreamServer server = server_with(100);
  for (std::int64_t consumer = 0; consumer < 1000; ++consumer)
    EXPECT_TRUE(server.on_ack({consumer, 0, 10, {}}, 0.0));
  EXPECT_FALSE(server.on_ack({1000, 0, 10, {}}, 0.0));
  EXPECT_TRUE(server.on_ack({999, 5, 10, {}}, 0.0));
}

TEST(StreamServer, WaitsForTheSlowestLivingConsumer) {
  StreamServer server = server_with(400);
  ack(server, 0, {}, 0.0, 50);
  EXPECT_EQ(server.due(0.0), (Ranges{{0, 50}}));
  EXPECT_EQ(server.due(1.0), Ranges{});
  ack(server, 50, {}, 1.0, 50);
  EXPECT_EQ(server.due(1.0), (Ranges{{50, 100}}));
  EXPECT_EQ(server.due(3.1), (Ranges{{100, 260}, {260, 400}}));  // it fell silent
}

TEST(StreamServer, AnOldAcknowledgementMovesNothingBack) {
  StreamServer server = server_with(400);
  ack(server, 300);
  ack(server, 100);
  EXPECT_EQ(server.slowest_cursor(), 300);
}

TEST(StreamServer, IsDrainedWhenEveryLivingConsumerKnowsThatItHasAll) {
  StreamServer server = server_with(400);
  server.due(0.0);
  ack(server, 400, {}, 0.0, 0);
  server.seal();
  EXPECT_FALSE(server.drained(1, 0.0));  // it cannot know yet
  ack(server, 400, {}, 0.0, 100);
  EXPECT_FALSE(server.drained(1, 0.0));
  ack(server, 400, {}, 0.0, 0);
  EXPECT_TRUE(server.drained(1, 0.0));
  ack(server, 300, {}, 0.0, 100);  // an old one
  EXPECT_TRUE(server.drained(1, 0.0));
  EXPECT_FALSE(server.drained(2, 0.0));
  EXPECT_TRUE(server.on_ack({8, 399, 10, {}}, 1.0));
  EXPECT_FALSE(server.drained(1, 1.0));
  EXPECT_FALSE(server.drained(1, 3.0));
  EXPECT_TRUE(server.drained(1, 3.1));  // the one that lacks a row fell silent
  EXPECT_FALSE(server.drained(2, 3.1));
}

TEST(StreamServer, WithoutConsumersItIsDrainedOnceAllHasGoneOut) {
  StreamServer server = server_with(1000);
  server.seal();
  server.due(0.0);  // 640 rows
  EXPECT_FALSE(server.drained(0, 0.0));
  server.due(1.0);
  EXPECT_TRUE(server.drained(0, 1.0));
}

TEST(StreamServer, TellsWhetherMoreIsToBeSent) {
  StreamServer server = server_with(1000);
  EXPECT_TRUE(server.backlog(0.0));
  server.due(0.0);  // 640 rows
  EXPECT_TRUE(server.backlog(0.0));
  server.due(1.0);
  EXPECT_FALSE(server.backlog(1.0));
  ack(server, 0, {{3, 4}}, 1.0);
  EXPECT_TRUE(server.backlog(1.0));
}

}  // namespace
}  // namespace rtg::stream

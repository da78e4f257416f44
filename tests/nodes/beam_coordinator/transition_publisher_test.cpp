#include "nodes/beam_coordinator/transition_publisher.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "nodes/jobs/flat_poses.hpp"
#include "tests/nodes/bus/handle_all.hpp"

namespace rtg::beam_coordinator {
namespace {

using namespace std::chrono_literals;
using rtg_msgs::stream_ack_t;
using rtg_msgs::stream_tail_t;
using rtg_msgs::transition_batch_t;

/// Number k of a stream of two bodies.
search::Transition row(int k) {
  const Poses poses{{k + 0.1, k + 0.2, k + 0.3}, {k + 0.4, k + 0.5, k + 0.6}};
  Poses next = poses;
  next[0].x += 100.0;
  return {poses, k % 48, next, k % 3 == 0, static_cast<search::Source>(k % 4)};
}

std::vector<search::Transition> rows(int first, int end) {
  std::vector<search::Transition> out;
  for (int k = first; k < end; ++k) out.push_back(row(k));
  return out;
}

/// A publisher and one that listens on the same bus.
struct TransitionPublisherTest : ::testing::Test {
  bus::Bus bus{"memq://", bus::RunKey::random("test")};
  std::vector<transition_batch_t> batches;
  std::vector<stream_tail_t> tails;
  TransitionPublisher publisher{bus, jobs::TaskShape{.bodies = 2, .actions = 48}, 3};
  bus::Seconds now = bus::monotonic_now();

  TransitionPublisherTest() {
    bus.subscribe<transition_batch_t>("RTG_TRANSITION",
                                      [this](const auto& m) { batches.push_back(m); });
    bus.subscribe<stream_tail_t>("RTG_TAIL", [this](const auto& m) { tails.push_back(m); });
  }

  void deliver() { testing::handle_all(bus); }

  /// Lets a second pass and delivers what then goes out.
  void tick() {
    publisher.tick(now += 1.0);
    deliver();
  }

  using Ranges = std::vector<std::pair<std::int64_t, std::int64_t>>;  // first, last

  void ack(std::int64_t cursor, int credit, const Ranges& missing = {}, std::int64_t stream = 0) {
    stream_ack_t message{};
    message.stream = stream == 0 ? tails.back().stream : stream;
    message.consumer = 7;
    message.cursor = cursor;
    message.credit = credit;
    message.n = static_cast<std::int32_t>(missing.size());
    for (const auto& [first, last] : missing) {
      message.first.push_back(first);
      message.last.push_back(last);
    }
    bus.publish("RTG_ACK", message);
    deliver();
  }

  /// Numbers of the rows that have come since the last call, in order.
  std::vector<std::int64_t> numbers() {
    std::vector<std::int64_t> out;
    for (const transition_batch_t& m : std::exchange(batches, {}))
      for (int k = 0; k < m.n; ++k) out.push_back(m.first + k);
    return out;
  }
};

TEST_F(TransitionPublisherTest, SendsEachRowOnceWithAllItsColumns) {
  publisher.store(rows(0, 3));
  tick();
  publisher.store(rows(3, 5));
  tick();
  tick();
  ASSERT_EQ(batches.size(), 2U);
  std::vector<double> poses, next_poses;
  for (int k = 3; k < 5; ++k) {
    jobs::append_poses(row(k).poses, poses);
    jobs::append_poses(row(k).next, next_poses);
  }
  const transition_batch_t& second = batches[1];
  EXPECT_EQ(second.first, 3);
  EXPECT_EQ(second.n, 2);
  EXPECT_EQ(second.n_poses, 2 * 2 * 3);
  EXPECT_EQ(second.poses, poses);
  EXPECT_EQ(second.next_poses, next_poses);
  EXPECT_EQ(second.action, (std::vector<std::int32_t>{3, 4}));
  EXPECT_EQ(second.success, (std::vector<std::int8_t>{1, 0}));
  EXPECT_EQ(second.source, (std::vector<std::int8_t>{3, 0}));
  EXPECT_EQ(numbers(), (std::vector<std::int64_t>{0, 1, 2, 3, 4}));
}

TEST_F(TransitionPublisherTest, SaysHowLongTheStreamIsAndWhetherItIsSealed) {
  publisher.store(rows(0, 3));
  tick();
  publisher.store(rows(3, 4));
  publisher.tick(now);  // too soon for another tail
  publisher.seal();
  publisher.tick(now);
  publisher.tick(now + 0.1);  // too soon again
  deliver();
  ASSERT_EQ(tails.size(), 2U);
  EXPECT_EQ(std::pair(tails[0].count, int{tails[0].sealed}), std::pair(std::int64_t{3}, 0));
  EXPECT_EQ(std::pair(tails[1].count, int{tails[1].sealed}), std::pair(std::int64_t{4}, 1));
  EXPECT_EQ(tails[0].stream, tails[1].stream);
  EXPECT_EQ(batches[0].stream, tails[0].stream);
}

TEST_F(TransitionPublisherTest, SendsAgainFromTheFirstToTheLastRowAskedFor) {
  publisher.store(rows(0, 20));
  tick();
  numbers();
  ack(3, 100, {{3, 5}, {9, 9}, {19, 19}});
  tick();
  EXPECT_EQ(numbers(), (std::vector<std::int64_t>{3, 4, 5, 9, 19}));
  EXPECT_EQ(publisher.state().resent, 5);
}

TEST_F(TransitionPublisherTest, RangesThatMakeNoSenseAreLeftOut) {
  publisher.store(rows(0, 20));
  tick();
  numbers();
  ack(3, 100, {{-1, 5}, {7, 6}, {18, 20}, {4, 4}});
  tick();
  EXPECT_EQ(numbers(), std::vector<std::int64_t>{4});
}

TEST_F(TransitionPublisherTest, AcknowledgementsOfAnotherStreamAndBeyondTheEndAreCounted) {
  publisher.store(rows(0, 20));
  tick();
  numbers();
  ack(3, 100, {{3, 5}}, tails.back().stream + 1);
  ack(21, 100, {{3, 5}});
  tick();
  EXPECT_TRUE(numbers().empty());
  publisher.seal();
  ack(21, 100, {{3, 5}});
  EXPECT_EQ(bus.counters().all(),
            (std::map<std::string, long>{
                {"stream.ack_ahead", 1}, {"stream.illegal_ack", 1}, {"stream.other_stream", 1}}));
  EXPECT_EQ(publisher.state().consumers, 0);
}

TEST_F(TransitionPublisherTest, IsDrainedOnceAConsumerKnowsThatItHasAll) {
  publisher.store(rows(0, 20));
  tick();
  ack(20, 100);
  EXPECT_FALSE(publisher.drained(1, now)) << "more may come";
  publisher.seal();
  tick();
  ack(20, 100);
  EXPECT_FALSE(publisher.drained(1, bus::monotonic_now())) << "it does not know yet";
  ack(20, 0);
  EXPECT_TRUE(publisher.drained(1, bus::monotonic_now()));
  const TransitionPublisher::State state = publisher.state();
  EXPECT_EQ(state.rows, 20);
  EXPECT_EQ(state.slowest_cursor, 20);
  EXPECT_EQ(state.consumers, 1);
  EXPECT_TRUE(state.sealed);
}

}  // namespace
}  // namespace rtg::beam_coordinator

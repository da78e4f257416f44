#include "nodes/bus/node_status.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <rtg_msgs/node_status_t.hpp>
#include <rtg_msgs/search_progress_t.hpp>
#include <vector>

#include "tests/nodes/bus/handle_all.hpp"

namespace rtg::bus {
namespace {

TEST(NodeStatus, SaysWhichNodeIsInWhichState) {
  Bus bus("memq://", RunKey::random("test"));
  std::vector<rtg_msgs::node_status_t> heard;
  bus.subscribe<rtg_msgs::node_status_t>(
      "RTG_STATUS", [&](const rtg_msgs::node_status_t& status) { heard.push_back(status); });
  NodeStatus(bus, "worker", 3).publish("solving", 17, {{"jobs", 2}});
  testing::handle_all(bus);
  ASSERT_EQ(heard.size(), 1U);
  EXPECT_EQ(heard[0].node, "worker");
  EXPECT_EQ(heard[0].number, 3);
  EXPECT_EQ(heard[0].state, "solving");
  EXPECT_EQ(heard[0].done, 17);
  EXPECT_NE(std::ranges::find(heard[0].counter_name, "jobs"), heard[0].counter_name.end());
}

// One that is started again stays. A leaving one says so several times, should an old message
// overtake.
TEST(CoordinatorWatch, ACoordinatorLeavesIfItsLastMessageSaysSo) {
  Bus bus("memq://", RunKey::random("test"));
  const CoordinatorWatch watch(bus);
  const auto leaves_after = [&](bool leaving) {
    rtg_msgs::search_progress_t progress{};
    progress.leaving = leaving;
    bus.publish("RTG_PROGRESS", progress);
    testing::handle_all(bus);
    return watch.leaving();
  };
  EXPECT_FALSE(leaves_after(false));
  EXPECT_TRUE(leaves_after(true));
  EXPECT_FALSE(leaves_after(false));
}

TEST(CoordinatorWatch, SilenceBeginsAtTheLastMessage) {
  Bus bus("memq://", RunKey::random("test"));
  const CoordinatorWatch watch(bus);
  const Seconds made = monotonic_now();
  while (monotonic_now() == made) {
  }
  const Seconds before = monotonic_now();
  EXPECT_TRUE(watch.silent(before + CoordinatorWatch::kSilence));
  bus.publish("RTG_PROGRESS", rtg_msgs::search_progress_t{});
  testing::handle_all(bus);
  EXPECT_FALSE(watch.silent(before + CoordinatorWatch::kSilence));
  EXPECT_TRUE(watch.silent(monotonic_now() + 1.01 * CoordinatorWatch::kSilence));
}

}  // namespace
}  // namespace rtg::bus

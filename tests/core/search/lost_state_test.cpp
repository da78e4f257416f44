#include "core/search/lost_state.hpp"

#include <gtest/gtest.h>

#include "tests/support/gathering.hpp"

namespace rtg {
namespace {

using testing::gathering;

/// Gathering with data at the nominal start only and a push that takes the robot 0.4 m to the
/// right.
struct LostStateTest : ::testing::Test {
  Task task = gathering();
  TreePolicy policy{task};
  SearchStats stats;
  bool solved = false;  // whether every push brings the objects to the goal

  LostStateTest() {
    for (int k = 0; k < 100; ++k) policy.add(task.start, 0, 1.0);
  }

  std::optional<Poses> lost(const std::vector<Poses>& starts) {
    const ReplayBatch replay = [this](std::span<const ReplayJob> jobs) {
      std::vector<ReplayResult> results;
      for (const ReplayJob& job : jobs) {
        Poses end = job.start;
        end[0].x += 0.4;
        if (solved)
          for (std::size_t k = 1; k < end.size(); ++k) end[k] = {0.0, 0.0, 0.0};
        results.push_back({end, true, 0.0});
      }
      return results;
    };
    return lost_state(task, policy, starts, replay, stats);
  }
};

TEST_F(LostStateTest, IsTheFirstStateOfAFailureThatIsFarFromTheData) {
  Poses expected = task.start;
  for (int k = 0; k < 3; ++k) expected[0].x += 0.4;
  EXPECT_EQ(lost({task.start}), expected);  // 1.2 m away; 0.8 m is near
}

TEST_F(LostStateTest, MayBeTheStartItself) {
  Poses far = task.start;
  far[0].y = 3.0;
  EXPECT_EQ(lost({far}), far);
}

TEST_F(LostStateTest, IsNoneIfThePolicySucceedsOrEndsNearTheData) {
  solved = true;
  EXPECT_EQ(lost({task.start, task.start}), std::nullopt);
  solved = false;
  task.horizon = 2;
  EXPECT_EQ(lost({task.start}), std::nullopt);
}

TEST_F(LostStateTest, IsNoneWithoutData) {
  policy = TreePolicy(task);
  EXPECT_EQ(lost({task.start}), std::nullopt);
  EXPECT_EQ(stats.rejected_pushes, 0);
}

}  // namespace
}  // namespace rtg

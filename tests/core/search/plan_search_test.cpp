#include "core/search/plan_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/search/roll_out.hpp"
#include "tests/support/gathering.hpp"

namespace rtg {
namespace {

using testing::gathering;
using testing::robot_at;

constexpr int kAstray = 10, kOn = 11;  // actions

/// Gathering with a simulator that needs no physics: one push takes the robot 0.5 m to the right,
/// at x > 2 m the objects come to the goal, too; another throws it 5 m back. The policy knows a
/// state every 0.5 m and likes the wrong push best.
struct PlanSearchTest : ::testing::Test {
  Task task = gathering();
  TreePolicy policy{task};
  SearchStats stats;
  std::vector<std::size_t> batches;  // sizes
  bool rejects = false;              // the right push

  PlanSearchTest() {
    task.horizon = 12;
    for (int k = 0; k <= 8; ++k) {
      const Poses state = robot_at(2.0 - 0.5 * k);
      policy.add(state, kAstray, 1.0 + k);
      policy.add(state, kOn, 1.25 + k);
    }
  }

  ReplayBatch replay = [this](std::span<const ReplayJob> jobs) {
    batches.push_back(jobs.size());
    std::vector<ReplayResult> results;
    for (const ReplayJob& job : jobs) results.push_back(pushed(job));
    return results;
  };

  ReplayResult pushed(const ReplayJob& job) const {
    Poses end = job.start;
    end[0].x += job.action == kOn ? 0.5 : -5.0;
    if (end[0].x > 2.0)
      for (std::size_t k = 1; k < end.size(); ++k) end[k] = {0.0, 0.0, 0.0};
    return {end, !rejects || job.action != kOn, 0.0};
  }

  std::vector<std::vector<Transition>> plans(const std::vector<Poses>& starts) {
    return search_plans(task, policy, starts, replay, stats);
  }
};

TEST_F(PlanSearchTest, FindsTheWayWhereThePolicyGoesAstray) {
  const std::vector<Poses> starts{robot_at(-1.0)};
  ASSERT_FALSE(run_episodes(task, policy, {starts}, replay, stats).front().success);
  const std::vector<Transition> plan = plans(starts).front();
  ASSERT_EQ(plan.size(), 7U);
  for (std::size_t k = 0; k < plan.size(); ++k) {
    EXPECT_EQ(plan[k].action, kOn);
    EXPECT_EQ(plan[k].next, pushed({plan[k].poses, kOn}).end);
    EXPECT_EQ(plan[k].success, k + 1 == plan.size());
    EXPECT_EQ(plan[k].source, Source::kMended);
    EXPECT_EQ(plan[k].poses, k == 0 ? starts.front() : plan[k - 1].next);
  }
}

TEST_F(PlanSearchTest, APlanIsNoLongerThanAnEpisode) {
  task.horizon = 7;
  EXPECT_EQ(plans({robot_at(-1.0)}).front().size(), 7U);
  task.horizon = 6;
  EXPECT_TRUE(plans({robot_at(-1.0)}).front().empty());
}

TEST_F(PlanSearchTest, WithoutAnEntryThereIsNoPlanAndNoPush) {
  policy.forget(0);
  EXPECT_TRUE(plans({robot_at(2.0)}).front().empty());
  EXPECT_TRUE(std::ranges::all_of(batches, [](std::size_t size) { return size == 0; }));
}

TEST_F(PlanSearchTest, ARejectedPushIsCountedAndLeadsNowhere) {
  rejects = true;
  EXPECT_TRUE(plans({robot_at(2.0)}).front().empty());
  EXPECT_GT(stats.rejected_pushes, 0);
}

TEST_F(PlanSearchTest, BeamsGoInLockstepAndKnowNothingOfEachOther) {
  const std::vector<Poses> starts{robot_at(1.0), robot_at(-20.0), robot_at(-1.0)};
  const auto all = plans(starts);
  EXPECT_EQ(batches.front(), 6U);  // two actions from each
  EXPECT_LE(batches.size(), 12U);
  for (std::size_t k = 0; k < starts.size(); ++k) EXPECT_EQ(plans({starts[k]}).front(), all[k]);
  EXPECT_EQ(all[0].size(), 3U);
  EXPECT_TRUE(plans({}).empty());
}

TEST_F(PlanSearchTest, EndsAfterTenStepsWithoutProgress) {
  task.horizon = 60;
  for (int k = 0; k < 40; ++k) policy.add(robot_at(-1.0), 12 + k % 30, 1.0 + k);
  const ReplayBatch stuck = [this](std::span<const ReplayJob> jobs) {
    batches.push_back(jobs.size());
    std::vector<ReplayResult> results;
    for (const ReplayJob& job : jobs) results.push_back({job.start, true, 0.0});
    return results;
  };
  const std::vector<Poses> starts{robot_at(-1.0)};
  EXPECT_TRUE(search_plans(task, policy, starts, stuck, stats)[0].empty());
  EXPECT_EQ(batches.size(), 11U) << "the first is the best so far";
}

TEST_F(PlanSearchTest, StatesThatAreTheSameAreKeptOnce) {
  task.horizon = 4;
  for (int k = 0; k < 40; ++k) {  // many ways back to one state
    Poses state = robot_at(-3.0);
    policy.add(state, 12 + k % 30, 1.0 + k);
  }
  plans({robot_at(-3.0)});
  EXPECT_EQ(batches.front(), 4U);
  EXPECT_LE(batches.at(1), 4U);  // from the one state that all four led to
}

}  // namespace
}  // namespace rtg

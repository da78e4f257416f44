#include "core/search/branches.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "core/search/search_stats.hpp"
#include "tests/support/dragging_world.hpp"

namespace rtg::search {
namespace {

TEST(OtherHeadings, AreSoManyDifferentOnesAndNeverTheStepsOwn) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Rng rng(seed);
    const int action = static_cast<int>(seed % 48);
    const std::vector<int> found = other_actions(action, 48, 6, rng);
    EXPECT_EQ(std::set<int>(found.begin(), found.end()).size(), 6U);
    for (const int heading : found) {
      EXPECT_NE(heading, action);
      EXPECT_GE(heading, 0);
      EXPECT_LT(heading, 48);
    }
  }
}

TEST(OtherHeadings, AreUniform) {
  std::map<int, int> counts;
  for (std::uint64_t seed = 0; seed < 4700; ++seed) {
    Rng rng(seed);
    ++counts[other_actions(10, 48, 2, rng)[1]];
  }
  EXPECT_EQ(counts.size(), 47U);
  for (const auto& [heading, count] : counts) EXPECT_NEAR(count, 100, 50) << heading;
}

TEST(OtherHeadings, EndWhereThereAreNoMore) {
  Rng rng(1);
  EXPECT_EQ(other_actions(0, 4, 9, rng).size(), 3U);
  EXPECT_EQ(other_actions(0, 1, 2, rng).size(), 0U);
  EXPECT_EQ(other_actions(5, 48, 0, rng).size(), 0U);
}

struct BranchesTest : ::testing::Test, testing::DraggingWorld {
  SearchConfig config;
  SearchStats stats;
  ReplayBatch counting = counted(replay, stats, Stage::kReplays);

  BranchesTest() { config.branches = 3; }

  std::vector<Transition> steps(int count) const {
    std::vector<Transition> out;
    for (int k = 0; k < count; ++k) {
      const Poses start = testing::moved(task.start, 0, {0.25 * k, 0.0});
      out.push_back({start, k, pushed({start, k}), false, Source::kTree});
    }
    return out;
  }
};

TEST_F(BranchesTest, FollowTheirStepAndAreTrueTransitionsFromItsState) {
  const std::vector<Transition> given = steps(5);
  const std::vector<Transition> rows = with_branches(task, given, config, 7, counting);
  ASSERT_EQ(rows.size(), 20U);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const Transition& step = given[k / 4];
    if (k % 4 == 0) {
      EXPECT_EQ(rows[k], step);
      continue;
    }
    EXPECT_EQ(rows[k].poses, step.poses);
    EXPECT_NE(rows[k].action, step.action);
    EXPECT_EQ(rows[k].next, pushed({step.poses, rows[k].action}));
    EXPECT_EQ(rows[k].success, succeeded(task, rows[k].next));
    EXPECT_EQ(rows[k].source, Source::kBranch);
  }
  EXPECT_EQ(stats.replays, 15);
}

TEST_F(BranchesTest, WhichHeadingsIsAFunctionOfStepAndSeedWhateverComesBeside) {
  const std::vector<Transition> given = steps(5);
  const auto all = with_branches(task, given, config, 7, counting);
  const auto one = with_branches(task, std::span(given).subspan(3, 1), config, 7, counting);
  EXPECT_TRUE(std::ranges::equal(one, std::span(all).subspan(12, 4)));
  EXPECT_NE(with_branches(task, given, config, 8, counting), all);
}

TEST_F(BranchesTest, ThatSucceedSayThatTheyDo) {
  Poses goal = task.start;
  for (std::size_t k = 1; k < goal.size(); ++k)
    goal[k] = {1.4 * static_cast<double>(k) - 2.8, 1.0, 0.0};
  const Transition step{goal, 0, pushed({goal, 0}), false, Source::kTree};
  for (const Transition& t : with_branches(task, {&step, 1}, config, 1, counting))
    EXPECT_EQ(t.success, t.source == Source::kBranch) << "all but the step lie";
}

TEST_F(BranchesTest, ThatTheSimulatorRejectsAreLeftOutAndCounted) {
  const ReplayBatch rejecting = [this](std::span<const ReplayJob> jobs) {
    std::vector<ReplayResult> results = replay(jobs);
    for (std::size_t k = 0; k < results.size(); k += 3) results[k].ok = false;
    return results;
  };
  const auto rows =
      with_branches(task, steps(5), config, 7, counted(rejecting, stats, Stage::kReplays));
  EXPECT_EQ(rows.size(), 15U);
  EXPECT_EQ(stats.rejected_pushes, 5);
}

}  // namespace
}  // namespace rtg::search

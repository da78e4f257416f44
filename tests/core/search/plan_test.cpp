#include "core/search/plan.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "core/search/search_stats.hpp"
#include "tests/support/dragging_world.hpp"

namespace rtg::search {
namespace {

struct PlanTest : ::testing::Test, testing::DraggingWorld {
  SearchStats stats;
  ReplayBatch counting = counted(replay, stats, Stage::kReplays);

  /// Gathering with the first box `off` to the right of its disc's edge, which is at 2 m.
  Poses short_of_success(double off) const {
    return {{-6.0, 0.0, 0.0}, {2.0 + off, 0.0, 0.0}, {-1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
  }
};

constexpr int kRight = 0;        // of 48 headings; a free move
constexpr int kDragsFirst = 25;  // drags the first box to the left, 7.5 degrees off

TEST_F(PlanTest, GoesOnToTheFirstSuccessFromStateToState) {
  // Headings 19 and 25 drag the first box, 25 by 7.5 degrees off the left.
  ASSERT_EQ(dragged(kDragsFirst), 1U);
  const Plan plan{short_of_success(0.6), {kRight, kDragsFirst, kDragsFirst, kRight}};
  const auto done = carry_out(task, std::vector{plan}, counting);
  ASSERT_TRUE(done.at(0).success);
  const std::vector<Transition>& steps = done[0].steps;
  ASSERT_EQ(steps.size(), 3U) << "it needs no fourth push";
  EXPECT_EQ(stats.replays, 3);
  Poses state = plan.start;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    EXPECT_EQ(steps[k].poses, state);
    EXPECT_EQ(steps[k].action, plan.actions[k]);
    EXPECT_EQ(steps[k].next, pushed({state, plan.actions[k]}));
    EXPECT_EQ(steps[k].success, k == 2);
    EXPECT_EQ(steps[k].source, Source::kTree);
    state = steps[k].next;
  }
}

TEST_F(PlanTest, IsEmptyWhereTheGoalHoldsAlreadyAndHasAllItsPushesWhereItFails) {
  const std::vector<Plan> plans{{short_of_success(-0.5), {kRight}},
                                {short_of_success(0.6), {kRight, kDragsFirst}},
                                {short_of_success(0.3), {kDragsFirst}},
                                {short_of_success(0.3), {}}};
  const auto done = carry_out(task, plans, counting);
  const std::vector<std::pair<bool, std::size_t>> expected{
      {true, 0}, {false, 2}, {true, 1}, {false, 0}};
  ASSERT_EQ(done.size(), expected.size());
  for (std::size_t k = 0; k < done.size(); ++k)
    EXPECT_EQ(std::pair(done[k].success, done[k].steps.size()), expected[k]);
  EXPECT_EQ(stats.replays, 3) << "each its own pushes alone";
}

TEST_F(PlanTest, EndsBeforeThePushThatTheSimulatorRejects) {
  int calls = 0;
  const ReplayBatch rejecting = [&](std::span<const ReplayJob> jobs) {
    return ++calls == 2 ? std::vector<ReplayResult>(jobs.size()) : replay(jobs);
  };
  const std::vector<Plan> plans{{short_of_success(0.6), {kRight, kDragsFirst, kDragsFirst}}};
  const auto done = carry_out(task, plans, rejecting);
  EXPECT_FALSE(done.at(0).success);
  EXPECT_EQ(done[0].steps.size(), 1U);
  EXPECT_EQ(calls, 2);
}

}  // namespace
}  // namespace rtg::search

#include "core/search/plan.hpp"

#include <gtest/gtest.h>

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
  ASSERT_TRUE(done.at(0).has_value());
  const std::vector<Transition>& steps = *done[0];
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

TEST_F(PlanTest, IsEmptyWhereTheGoalHoldsAlreadyAndNothingWhereItFails) {
  const std::vector<Plan> plans{{short_of_success(-0.5), {kRight}},
                                {short_of_success(0.6), {kRight, kDragsFirst}},
                                {short_of_success(0.3), {kDragsFirst}},
                                {short_of_success(0.3), {}}};
  const auto done = carry_out(task, plans, counting);
  ASSERT_TRUE(done.at(0).has_value());
  EXPECT_TRUE(done[0]->empty());
  EXPECT_FALSE(done[1].has_value());
  ASSERT_TRUE(done[2].has_value());
  EXPECT_EQ(done[2]->size(), 1U);
  EXPECT_FALSE(done[3].has_value());
  EXPECT_EQ(stats.replays, 3) << "each its own pushes alone";
}

TEST_F(PlanTest, EndsWhereTheSimulatorRejectsAPush) {
  const ReplayBatch none = [](std::span<const ReplayJob> jobs) {
    return std::vector<ReplayResult>(jobs.size());
  };
  const std::vector<Plan> plans{{short_of_success(0.3), {kDragsFirst, kDragsFirst}}};
  EXPECT_FALSE(carry_out(task, plans, none).at(0).has_value());
}

}  // namespace
}  // namespace rtg::search

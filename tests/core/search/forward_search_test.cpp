#include "core/search/forward_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <span>
#include <stdexcept>
#include <utility>

#include "tests/support/art_manip.hpp"
#include "tests/support/dragging_world.hpp"
#include "tests/support/generation_run.hpp"

namespace rtg::search {
namespace {

using testing::moved;

struct ForwardSearchTest : ::testing::Test, testing::DraggingWorld {
  SearchConfig config;
  SearchStats stats;
  Poses start = task.start;

  ForwardSearchTest() {
    config.forward_breadth = 12;
    config.depth = 20;
  }
};

TEST_F(ForwardSearchTest, ReplaysEveryHeadingOfEveryStateOfItsBeam) {
  ForwardSearch search(task, config, start);
  std::vector<Poses> beam{start};
  for (int layer = 0; layer < 3; ++layer) {
    std::vector<ReplayJob> expected, seen;
    for (const Poses& state : beam)
      for (int action = 0; action < 48; ++action) expected.push_back({state, action});
    const ReplayBatch noting = [&](std::span<const ReplayJob> jobs) {
      seen.assign(jobs.begin(), jobs.end());
      return replay(jobs);
    };
    beam.clear();
    for (const Transition& t : search.grow(counted(noting, stats, Stage::kReplays)))
      beam.push_back(t.next);
    EXPECT_EQ(seen, expected);
    EXPECT_EQ(beam.size(), 12U);
  }
  EXPECT_EQ(stats.replays, 48 + 2 * 12 * 48);
}

TEST_F(ForwardSearchTest, KnowsTheOutcomesOfItsLastLayer) {
  ForwardSearch search(task, config, start);
  const std::vector<Transition> first = search.grow(replay);
  for (int action = 0; action < 48; ++action)
    EXPECT_EQ(search.outcome({start, action}).end, pushed({start, action}));
  search.grow(replay);
  for (int action = 0; action < 48; ++action)
    EXPECT_EQ(search.outcome({first[3].next, action}).end, pushed({first[3].next, action}));
  EXPECT_THROW((void)search.outcome({start, 0}), std::out_of_range);
}

TEST_F(ForwardSearchTest, FindsAPlanOfTrueStepsToSuccess) {
  const std::vector<Transition> plan = plan_forward(task, config, start, replay);
  ASSERT_FALSE(plan.empty());
  Poses state = start;
  for (const Transition& t : plan) {
    EXPECT_EQ(t.poses, state);
    EXPECT_EQ(t.next, pushed({t.poses, t.action}));
    EXPECT_EQ(t.success, &t == &plan.back());
    EXPECT_EQ(t.source, Source::kForward);
    state = t.next;
  }
  EXPECT_TRUE(succeeded(task, state));
}

TEST_F(ForwardSearchTest, EndsWithItsFirstSuccess) {
  ForwardSearch search(task, config, start);
  std::vector<Transition> last;
  for (int layer = 0; layer < config.depth; ++layer) {
    std::vector<Transition> kept = search.grow(replay);
    if (kept.empty()) break;
    last = std::move(kept);
  }
  EXPECT_TRUE(std::ranges::any_of(last, &Transition::success));
  EXPECT_TRUE(search.grow(replay).empty());
}

TEST_F(ForwardSearchTest, PlansTheBestSuccessOfItsLastLayer) {
  task.goal = testing::near_origin(100.0);  // every state succeeds
  ForwardSearch search(task, config, start);
  const std::vector<Transition> kept = search.grow(replay);
  ASSERT_GT(kept.size(), 1U);
  EXPECT_TRUE(std::ranges::all_of(kept, &Transition::success));
  EXPECT_EQ(search.plan(), std::vector{kept.front()});
}

TEST_F(ForwardSearchTest, HasNoPlanWithinTooFewActions) {
  config.depth = 2;
  EXPECT_TRUE(plan_forward(task, config, start, replay).empty());
  config.depth = 20;
  task.horizon = 2;
  EXPECT_TRUE(plan_forward(task, config, start, replay).empty());
}

TEST_F(ForwardSearchTest, APushThatTheSimulatorRejectsLeadsNowhere) {
  const ReplayBatch none = [](std::span<const ReplayJob> jobs) {
    return std::vector<ReplayResult>(jobs.size());
  };
  ForwardSearch search(task, config, start);
  EXPECT_TRUE(search.grow(counted(none, stats, Stage::kReplays)).empty());
  EXPECT_EQ(stats.rejected_pushes, 48);
  EXPECT_TRUE(search.plan().empty());
}

TEST_F(ForwardSearchTest, DoesNotGoBackToItsStart) {
  const ReplayBatch held_up = [&](std::span<const ReplayJob> jobs) {
    return std::vector<ReplayResult>(jobs.size(), {start, true, 0.0});
  };
  EXPECT_TRUE(ForwardSearch(task, config, start).grow(held_up).empty());
}

TEST(GenerateForward, StoresWhatItsBeamsKeepWithBranches) {
  SearchConfig config;
  config.generator = Generator::kForward;
  config.transitions = 1000;
  config.forward_breadth = 10;
  const auto run = testing::run_naive(testing::gathering(), config, 3, 1);
  ASSERT_EQ(run.stored.size(), 1000U);
  const auto branches = std::ranges::count(run.stored, Source::kBranch, &Transition::source);
  // Steps from one state may ask for the same headings; any other has four branches of its own.
  std::map<std::uint64_t, std::pair<int, int>> of_state;          // steps, branches
  for (const Transition& t : std::span(run.stored).first(995)) {  // the last may be cut off
    auto& [steps, beside] = of_state[reverse::key_of(t.poses, 0)];
    ++(t.source == Source::kForward ? steps : beside);
  }
  for (const auto& [state, counts] : of_state) {
    EXPECT_TRUE(counts.first > 1 || counts.second == 4 ||
                state == reverse::key_of(run.stored[994].poses, 0));
    EXPECT_LE(counts.second, 4 * counts.first);
  }
  EXPECT_NEAR(branches, 800, 40);
  EXPECT_GT(run.report.coverage.headings_per_state, 5.0);
  EXPECT_EQ(run.stored.size() - branches,
            std::ranges::count(run.stored, Source::kForward, &Transition::source));
  EXPECT_EQ(run.report.stats.replays % 48, 0) << "the branches are pushes of the layers";
  EXPECT_EQ(testing::run_naive(testing::gathering(), config, 3, 2).stored, run.stored);
}

}  // namespace
}  // namespace rtg::search

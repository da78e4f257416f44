#include "core/search/data_set.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/search/search_stats.hpp"
#include "tests/support/dragging_world.hpp"

namespace rtg::search {
namespace {

struct DataSetTest : ::testing::Test, testing::DraggingWorld {
  SearchConfig config;
  SearchStats stats;
  ReplayBatch counting = counted(replay, stats, Stage::kReplays);
  std::vector<Transition> stored;
  TransitionSink sink = [this](std::span<const Transition> rows) {
    stored.insert(stored.end(), rows.begin(), rows.end());
  };

  std::vector<Transition> steps(int count) const {
    std::vector<Transition> out;
    for (int k = 0; k < count; ++k) {
      const Poses start = testing::moved(task.start, 0, {0.125 * k, 0.0});
      out.push_back({start, k, pushed({start, k}), false, Source::kTree});
    }
    return out;
  }
};

TEST_F(DataSetTest, HasEachStepWithItsBranchesBehindIt) {
  config.transitions = 1000;
  config.branches = 2;
  DataSet data(task, config, 1, sink);
  const std::vector<Transition> given = steps(4);
  data.store(std::span(given).first(3), counting);
  data.store(std::span(given).last(1), counting);
  ASSERT_EQ(stored.size(), 12U);
  for (std::size_t k = 0; k < stored.size(); ++k) {
    EXPECT_EQ(stored[k].poses, given[k / 3].poses);
    EXPECT_EQ(stored[k].source, k % 3 == 0 ? Source::kTree : Source::kBranch);
  }
  EXPECT_FALSE(data.full());
  EXPECT_EQ(data.coverage().transitions(), 12);
}

TEST_F(DataSetTest, IsFullWithWhatWasAskedForAndSimulatesNoMore) {
  config.transitions = 11;
  config.branches = 4;
  DataSet data(task, config, 1, sink);
  data.store(steps(40), counting);
  EXPECT_TRUE(data.full());
  EXPECT_EQ(stored.size(), 11U);
  EXPECT_EQ(stats.replays, 3 * 4) << "the branches of the third step, of which none fits";
  data.store(steps(1), counting);
  EXPECT_EQ(stored.size(), 11U);
}

// Two steps from one state have branches in common, so that the data are not full with them. A step
// that the first call has left out for want of room can come again.
TEST_F(DataSetTest, TakesAStepLaterForWhichThereWasNoRoom) {
  config.transitions = 60;
  config.branches = 40;  // of 47 others
  DataSet data(task, config, 1, sink);
  const std::vector<Transition> given = steps(2);
  Transition beside = given[0];
  beside.next = pushed({beside.poses, ++beside.action});
  const std::vector<Transition> all{given[0], beside, given[1]};
  data.store(all, counting);
  ASSERT_LE(stored.size(), 48U);
  data.store(all, counting);
  EXPECT_EQ(stored.size(), 60U);
  EXPECT_TRUE(std::ranges::any_of(stored, [&](const Transition& t) { return t == given[1]; }));
}

TEST_F(DataSetTest, HasNothingTwice) {
  config.transitions = 1000;
  config.branches = 2;
  DataSet data(task, config, 1, sink);
  data.store(steps(4), counting);
  const std::vector<Transition> before = stored;
  const long replays = stats.replays;
  data.store(steps(4), counting);
  EXPECT_EQ(stored, before);
  EXPECT_EQ(stats.replays, replays);
}

TEST_F(DataSetTest, AStepIsNoBranchOfAnother) {
  config.transitions = 1000;
  config.branches = 40;  // of 47 others
  DataSet data(task, config, 1, sink);
  std::vector<Transition> given;
  for (int action = 0; action < 20; ++action)
    given.push_back({task.start, action, pushed({task.start, action}), false, Source::kTree});
  data.store(given, counting);
  EXPECT_EQ(std::ranges::count(stored, Source::kTree, &Transition::source), 20);
  EXPECT_EQ(stored.size(), 48U);
}

TEST_F(DataSetTest, WithoutBranchesIsTheStepsAlone) {
  config.transitions = 1000;
  config.branches = 0;
  DataSet data(task, config, 1, sink);
  data.store(steps(5), counting);
  EXPECT_EQ(stored, steps(5));
  EXPECT_EQ(stats.replays, 0);
}

}  // namespace
}  // namespace rtg::search

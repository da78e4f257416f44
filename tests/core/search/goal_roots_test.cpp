#include "core/search/goal_roots.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>
#include <string>

#include "core/search/start_distance.hpp"
#include "core/search/state_metric.hpp"
#include "tests/support/art_manip.hpp"
#include "tests/support/gathering.hpp"

namespace rtg::search {
namespace {

using testing::gathering;
using testing::gathering_hard;

constexpr int kStates = 500;

Poses random_poses(const tasks::Task& task, Rng& rng) {
  Poses out = task.start;
  for (Pose& p : out) p = {rng.uniform(-5.0, 5.0), rng.uniform(-5.0, 5.0), rng.uniform(-3.0, 3.0)};
  return out;
}

double distance(const tasks::Task& task, const Poses& a, const Poses& b) {
  return StateMetric(task.scene).layout_distance(a, b);
}

Poses exchanged(Poses poses, std::size_t i, std::size_t j) {
  std::swap(poses[i], poses[j]);
  return poses;
}

/// Least distance over all ways to share out the poses of Gathering's three boxes.
double least_distance(const tasks::Task& task, const Poses& poses, const Poses& target) {
  double least = std::numeric_limits<double>::infinity();
  std::vector<std::size_t> order{1, 2, 3};
  do {
    const Poses trial{poses[0], poses[order[0]], poses[order[1]], poses[order[2]]};
    least = std::min(least, distance(task, trial, target));
  } while (std::ranges::next_permutation(order).found);
  return least;
}

TEST(WithSwappedTwins, LeavesBodiesWithJointsAlone) {
  const tasks::Task task = testing::art_manip();
  const Poses mixed = exchanged(task.start, 1, 4);
  EXPECT_EQ(with_swapped_twins(task, StateMetric(task.scene), mixed, task.start), mixed);
}

TEST(WithSwappedTwins, UndoesEveryExchangeOfThreeAlike) {
  const tasks::Task task = gathering();
  std::vector<std::size_t> order{1, 2, 3};
  do {
    const Poses mixed{task.start[0], task.start[order[0]], task.start[order[1]],
                      task.start[order[2]]};
    EXPECT_EQ(with_swapped_twins(task, StateMetric(task.scene), mixed, task.start), task.start);
  } while (std::ranges::next_permutation(order).found);
}

TEST(WithSwappedTwins, IsNoFartherThanBeforeNorThanAfterAnyFurtherExchange) {
  const tasks::Task task = gathering_hard();
  Rng rng(61);
  int nearer = 0;
  for (int k = 0; k < kStates; ++k) {
    const Poses poses = random_poses(task, rng), target = random_poses(task, rng);
    const Poses out = with_swapped_twins(task, StateMetric(task.scene), poses, target);
    const double least = distance(task, out, target);
    EXPECT_LE(least, distance(task, poses, target));
    nearer += least < distance(task, poses, target);
    for (std::size_t i = 1; i < out.size(); ++i)
      for (std::size_t j = i + 1; j < out.size(); ++j)
        EXPECT_LE(least, distance(task, exchanged(out, i, j), target));
  }
  EXPECT_GT(nearer, kStates / 2);  // 23 of 24 labellings are not the nearest
}

// A cycle of three may be nearer where no exchange of two is: in 6 of these 500.
TEST(WithSwappedTwins, IsTheNearestLabellingOfThreeAlmostAlways) {
  const tasks::Task task = gathering();
  Rng rng(62);
  int nearest = 0;
  for (int k = 0; k < kStates; ++k) {
    const Poses poses = random_poses(task, rng), target = random_poses(task, rng);
    const double least = least_distance(task, poses, target);
    const double found =
        distance(task, with_swapped_twins(task, StateMetric(task.scene), poses, target), target);
    EXPECT_GE(found, least - 1e-9);  // sums in another order
    nearest += found <= least + 1e-9;
  }
  EXPECT_GT(nearest, kStates * 97 / 100);
}

TEST(WithSwappedTwins, ExchangesOnlyWhatLooksTheSame) {
  tasks::Task task = gathering_hard();
  task.scene.bodies[3].kind = "other";
  task.scene.bodies[4].kind = "other";
  Rng rng(63);
  for (int k = 0; k < kStates; ++k) {
    const Poses poses = random_poses(task, rng);
    const Poses out =
        with_swapped_twins(task, StateMetric(task.scene), poses, random_poses(task, rng));
    EXPECT_EQ(out[0], poses[0]);
    for (const std::size_t i : {1U, 3U})
      EXPECT_TRUE((out[i] == poses[i] && out[i + 1] == poses[i + 1]) ||
                  (out[i] == poses[i + 1] && out[i + 1] == poses[i]));
  }
}

TEST(WithSwappedTwins, EveryDifferenceOfLooksCounts) {
  const auto stays = [](auto change) {
    tasks::Task task = gathering();
    change(task.scene.bodies[1]);
    const Poses crossed = exchanged(task.start, 1, 2);
    return with_swapped_twins(task, StateMetric(task.scene), crossed, task.start) == crossed;
  };
  EXPECT_FALSE(stays([](Body& b) { b.name = "another"; }));
  EXPECT_TRUE(stays([](Body& b) { b.kind = "other"; }));
  EXPECT_TRUE(stays([](Body& b) { b.shape = box(1.2, 1.3); }));
  EXPECT_TRUE(stays([](Body& b) { b.density = 2.0; }));
  EXPECT_TRUE(stays([](Body& b) { b.friction = 0.4; }));
  EXPECT_TRUE(stays([](Body& b) { b.fixed = true; }));
}

TEST(WithSwappedTwins, TheRobotStaysWhateverLooksLikeIt) {
  tasks::Task task = gathering();
  task.scene.bodies[1] = task.scene.bodies[0];
  const Poses crossed = exchanged(task.start, 0, 1);
  EXPECT_EQ(with_swapped_twins(task, StateMetric(task.scene), crossed, task.start), crossed);
}

SearchConfig of(int breadth, int root_draws) {
  SearchConfig config;
  config.breadth = breadth;
  config.root_draws = root_draws;
  return config;
}

std::vector<Poses> roots(const tasks::Task& task, const SearchConfig& config, std::uint64_t seed) {
  Rng rng(seed);
  SearchStats stats;
  return goal_roots(task, config, StateMetric(task), task.start, rng, stats);
}

TEST(GoalRoots, DrawsInVainAreCountedAndEndNothingUntilThereAreTooMany) {
  tasks::Task task = gathering();
  task.goal = testing::near_origin(0.04);  // no room for three
  Rng rng(1);
  SearchStats stats;
  EXPECT_TRUE(goal_roots(task, of(20, 4), StateMetric(task), task.start, rng, stats).empty());
  EXPECT_EQ(stats.undrawn_goals, 20);
  EXPECT_EQ(stats.goal_draws, 20);
  const std::string reason = main_reason(stats.goal_refusals, task.scene);
  EXPECT_NE(reason.find("than the clearance in "), std::string::npos) << reason;
}

TEST(GoalRoots, OnlyDrawsInVainInARowEndTheDrawing) {
  tasks::Task task = gathering();
  task.goal = {{"*", tasks::CentreIn{tasks::Disc{
                         {0.0, 0.0}, 0.88}}}};  // so tight that two of five draws are in vain
  Rng rng(1);
  SearchStats stats;
  EXPECT_EQ(goal_roots(task, of(15, 4), StateMetric(task), task.start, rng, stats).size(), 4U);
  EXPECT_GT(stats.undrawn_goals, 20);
  EXPECT_GT(stats.goal_draws, stats.undrawn_goals);
}

TEST(GoalRoots, AreDistinctGoalsNearestFirst) {
  const tasks::Task task = gathering();
  const StateMetric metric(task.scene);
  const std::vector<Poses> found = roots(task, of(20, 4), 64);
  ASSERT_EQ(found.size(), 5U);
  std::set<std::uint64_t> cells;
  double before = 0.0;
  for (const Poses& root : found) {
    EXPECT_TRUE(succeeded(task, root));
    EXPECT_EQ(with_swapped_twins(task, StateMetric(task.scene), root, task.start), root);
    EXPECT_TRUE(cells.insert(metric.cell(root)).second);
    const double left = start_distance(task, metric, root, task.start);
    EXPECT_GE(left, before);
    before = left;
  }
}

TEST(GoalRoots, AreTheNearestOfAllDraws) {
  const tasks::Task task = gathering();
  const std::vector<Poses> all = roots(task, of(80, 1), 65);
  const std::vector<Poses> best = roots(task, of(20, 4), 65);
  ASSERT_GE(all.size(), 20U);
  EXPECT_EQ(best, std::vector<Poses>(all.begin(), all.begin() + 5));
}

// A disc just large enough for one box and no room for the robot elsewhere: few cells.
TEST(GoalRoots, StatesOfOneCellAreOneRoot) {
  tasks::Task task = gathering();
  task.scene.bodies.resize(2);
  task.start.resize(2);
  task.goal = testing::near_origin(0.1);
  task.push.arena = 1.6;
  const std::vector<Poses> found = roots(task, of(400, 4), 66);
  const StateMetric metric(task.scene);
  std::set<std::uint64_t> cells;
  for (const Poses& root : found) EXPECT_TRUE(cells.insert(metric.cell(root)).second);
  EXPECT_LT(found.size(), 400U);
  EXPECT_GT(found.size(), 10U);
}

TEST(GoalRoots, AreAFunctionOfTheRandomStream) {
  const tasks::Task task = gathering();
  EXPECT_EQ(roots(task, of(8, 2), 67), roots(task, of(8, 2), 67));
  EXPECT_NE(roots(task, of(8, 2), 67), roots(task, of(8, 2), 68));
}

TEST(GoalRoots, OfAnImpossibleGoalAreNone) {
  tasks::Task task = gathering();
  task.goal = testing::near_origin(0.04);  // no room for three
  EXPECT_TRUE(roots(task, of(2, 1), 69).empty());
}

// The robot is pushed without turning.
TEST(GoalRoots, HaveTheRobotsAngleOfTheTarget) {
  const tasks::Task task = gathering();
  Poses target = task.start;
  target[0].theta = 0.5;
  SearchConfig config;
  config.breadth = 8;
  Rng rng(1);
  SearchStats stats;
  const std::vector<Poses> roots = goal_roots(task, config, StateMetric(task), target, rng, stats);
  ASSERT_FALSE(roots.empty());
  for (const Poses& root : roots) EXPECT_EQ(root[0].theta, 0.5);
}

}  // namespace
}  // namespace rtg::search

#include "core/search/roll_out.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "tests/support/gathering.hpp"

namespace rtg {
namespace {

using testing::gathering;
using testing::robot_at;

/// Gathering with a policy of one action and a simulator that needs no physics: a push takes the
/// robot 0.5 m to the right; at x > 2 m the objects come to the goal, too.
struct RollOutTest : ::testing::Test {
  Task task = gathering();
  TreePolicy policy{task};
  SearchStats stats;
  std::vector<std::size_t> batches;  // sizes
  int rejected = -1;                 // action that the simulator cannot finish

  ReplayBatch replay = [this](std::span<const ReplayJob> jobs) {
    batches.push_back(jobs.size());
    std::vector<ReplayResult> results;
    for (const ReplayJob& job : jobs) results.push_back(pushed(job));
    return results;
  };

  ReplayResult pushed(const ReplayJob& job) const {
    Poses end = job.start;
    end[0].x += 0.5;
    if (end[0].x > 2.0)
      for (std::size_t k = 1; k < end.size(); ++k) end[k] = {0.0, 0.0, 0.0};
    return {end, job.action != rejected, 0.0};
  }

  /// An entry at the start; all are alike to the policy, which knows no robot's heading.
  void add_entry(int action) {
    Poses state = task.start;
    state[0].theta = policy.size();
    policy.add(state, action, 1.0);
  }

  /// Entries with actions 10, 11, 12, ...
  void add_entries(int count) {
    for (int k = 0; k < count; ++k) add_entry((10 + k) % task.push.headings);
  }

  std::vector<Episode> run(const std::vector<Poses>& starts, double noise = 0.0,
                           std::uint64_t seed = 3) {
    return run_episodes(task, policy, {starts, noise, seed}, replay, stats);
  }
};

std::vector<int> actions(const Episode& episode) {
  std::vector<int> out;
  for (const Transition& t : episode.steps) out.push_back(t.action);
  return out;
}

TEST_F(RollOutTest, SuccessEndsAnEpisode) {
  add_entries(20);
  const std::vector<Episode> episodes = run({robot_at(1.0), robot_at(0.0)});
  ASSERT_EQ(episodes.size(), 2U);
  EXPECT_EQ(episodes[0].steps.size(), 3U);
  EXPECT_EQ(episodes[1].steps.size(), 5U);
  for (const Episode& e : episodes) {
    EXPECT_TRUE(e.success);
    for (const Transition& t : e.steps) EXPECT_EQ(t.success, &t == &e.steps.back());
  }
  EXPECT_EQ(batches, (std::vector<std::size_t>{2, 2, 2, 1, 1}));  // in lockstep
}

TEST_F(RollOutTest, TheHorizonEndsAnEpisode) {
  add_entries(20);
  task.horizon = 4;
  const std::vector<Episode> episodes = run({robot_at(-5.0), robot_at(1.5), robot_at(0.5)});
  EXPECT_EQ(episodes[0].steps.size(), 4U);
  EXPECT_FALSE(episodes[0].success);
  EXPECT_EQ(episodes[1].steps.size(), 2U);
  EXPECT_EQ(episodes[2].steps.size(), 4U);  // both at once
  EXPECT_TRUE(episodes[2].success);
}

TEST_F(RollOutTest, ARejectedPushEndsAnEpisodeAndIsCountedNotStored) {
  add_entries(20);
  rejected = 12;
  const std::vector<Episode> episodes = run({robot_at(-5.0), robot_at(1.5)});
  EXPECT_EQ(actions(episodes[0]), (std::vector{10, 11}));
  EXPECT_FALSE(episodes[0].success);
  EXPECT_TRUE(episodes[1].success);
  EXPECT_EQ(stats.rejected_pushes, 1);
}

TEST_F(RollOutTest, EachStepStartsWhereTheOneBeforeEnded) {
  add_entries(20);
  const Episode episode = run({robot_at(0.0)}).front();
  EXPECT_EQ(episode.steps[0].poses, robot_at(0.0));
  for (std::size_t k = 0; k < episode.steps.size(); ++k) {
    const Transition& t = episode.steps[k];
    EXPECT_EQ(t.next, pushed({t.poses, t.action}).end);
    EXPECT_EQ(t.source, Source::kRollOut);
    if (k > 0) {
      EXPECT_EQ(t.poses, episode.steps[k - 1].next);
    }
  }
}

// All entries are the nominal start, the robot at (0, -5); it strays by half a metre a push.
TEST_F(RollOutTest, TellsHowFarEachStateIsFromTheData) {
  add_entries(20);
  EXPECT_EQ(run({robot_at(0.5)}).front().strayed, (std::vector{0.5, 1.0, 1.5, 2.0}));
}

TEST_F(RollOutTest, AnEpisodeUsesEachEntryOnce) {
  add_entries(7);
  task.horizon = 7;
  for (const Episode& e : run({robot_at(-5.0), robot_at(-5.0)})) {
    EXPECT_EQ(actions(e), (std::vector{10, 11, 12, 13, 14, 15, 16}));  // ties go to the oldest
  }
}

TEST_F(RollOutTest, WithoutAnEntryLeftActionsAreDrawnFromAll) {
  task.horizon = 5000;
  const Episode e = run({robot_at(-5000.0)}).front();
  std::vector<int> count(48);
  for (const int action : actions(e)) ++count.at(static_cast<std::size_t>(action));
  // Mean 104, standard deviation 10.
  EXPECT_GT(*std::ranges::min_element(count), 104 - 50);
  EXPECT_LT(*std::ranges::max_element(count), 104 + 50);
  EXPECT_EQ(e.strayed, std::vector<double>(5000, INFINITY));
}

TEST_F(RollOutTest, NoiseTakesANeighbourByOneOrTwo) {
  task.horizon = 400;
  for (int k = 0; k < 400; ++k) add_entry(1);  // 2 to the right of 0: wraps
  std::set<int> taken;
  for (const int action : actions(run({robot_at(-500.0)}, 1.0).front())) taken.insert(action);
  EXPECT_EQ(taken, (std::set<int>{47, 0, 2, 3}));
}

TEST_F(RollOutTest, NoiseDisturbsItsShareOfTheActions) {
  task.horizon = 2000;
  for (int k = 0; k < 2000; ++k) add_entry(20);
  const std::vector<int> all = actions(run({robot_at(-5000.0)}, 0.1).front());
  // Mean 200, standard deviation √(2000 · 0.1 · 0.9) = 13.4.
  EXPECT_NEAR(2000 - std::ranges::count(all, 20), 200, 5 * 13.4);
}

TEST_F(RollOutTest, NoiseIsAFunctionOfSeedAndEpisodeNumberOnly) {
  add_entries(20);
  task.horizon = 20;
  const auto both = run({robot_at(-50.0), robot_at(-50.0)}, 0.5);
  const auto first_ends = run({robot_at(1.9), robot_at(-50.0), robot_at(-50.0)}, 0.5);
  EXPECT_EQ(actions(first_ends[1]), actions(both[1]));
  EXPECT_NE(actions(both[0]), actions(both[1]));
  EXPECT_NE(actions(first_ends[2]), actions(both[1]));
  EXPECT_NE(actions(run({robot_at(-50.0)}, 0.5, 4)[0]), actions(both[0]));
  EXPECT_EQ(actions(run({robot_at(-50.0)}, 0.5)[0]), actions(both[0]));
}

TEST_F(RollOutTest, OfNoStartsAreNoEpisodes) {
  EXPECT_TRUE(run({}).empty());
  EXPECT_TRUE(batches.empty());
}

TEST_F(RollOutTest, TheScoreCountsSuccessesAndPushesOfAllEpisodes) {
  add_entries(20);
  task.horizon = 4;
  const std::vector<Poses> starts{robot_at(-5.0), robot_at(1.5), robot_at(1.0),
                                  robot_at(-4.0)};  // 4, 2, 3, 4
  const PolicyScore score = evaluate_policy(task, policy, starts, replay, stats);
  EXPECT_DOUBLE_EQ(score.success, 0.5);
  EXPECT_DOUBLE_EQ(score.length_mean, 13.0 / 4.0);
}

/// Largest |Δx| or |Δy| of an object from its nominal start.
double offset(const Task& task, const Poses& poses) {
  double most = 0.0;
  for (std::size_t k = 1; k < poses.size(); ++k)
    most = std::max(
        {most, std::abs(poses[k].x - task.start[k].x), std::abs(poses[k].y - task.start[k].y)});
  return most;
}

TEST(JitteredStarts, MoveObjectsByUpToAnAmplitudeOfTheirOwn) {
  const Task task = gathering();
  Rng rng(51);
  const std::vector<Poses> starts = jittered_starts(task, 400, 0.25, rng);
  ASSERT_EQ(starts.size(), 400U);
  double most = 0.0;
  long small = 0;
  for (const Poses& poses : starts) {
    EXPECT_EQ(poses[0], task.start[0]);
    most = std::max(most, offset(task, poses));
    small += offset(task, poses) < 0.05;
  }
  EXPECT_LE(most, 0.25 + 1e-6);  // single precision
  EXPECT_GT(most, 0.2);
  // At a fifth of the amplitude or below it is sure; at a share s > 1/5 all six coordinates stay
  // within with (1/5s)⁶. Mean 0.2 + ∫ (5s)⁻⁶ ds = 0.24, standard deviation of the count 8.5.
  EXPECT_NEAR(static_cast<double>(small), 0.24 * 400, 5 * 8.5);
}

TEST(JitteredStarts, AreNeverInTheGoal) {
  Task task = gathering();
  task.goal[0].radius = 3.46;  // the second box starts 1 mm outside: two of five states are in it
  Rng rng(53);
  for (const Poses& poses : jittered_starts(task, 200, 0.5, rng))
    EXPECT_FALSE(succeeded(task, poses));
}

}  // namespace
}  // namespace rtg

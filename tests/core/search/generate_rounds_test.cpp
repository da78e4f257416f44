#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "core/search/roll_out.hpp"
#include "tests/support/scripted_world.hpp"

namespace rtg {
namespace {

using testing::ScriptedWorld;
using testing::trees_only;

// Actions; the robot pushes away from all objects.
constexpr int kFirst = 34, kLast = 36, kOther = 38;

/// Two steps lead from the start to success; the first one ends `miss` beside what was solved for.
/// Near that end there begins another step, which is of no use there.
struct TwoSteps : ScriptedWorld {
  explicit TwoSteps(double miss) {
    task.start_jitter = 0.0;
    task.horizon = 2;
    layers = {{{kLast, start_but(1.0)}, {kOther, start_but(1.0 + miss + 0.0625)}},
              {{kFirst, task.start}}};
    pushed = [this, miss](const Poses& poses, int action) {
      const Poses between = start_but(1.0 + miss);
      const bool last = action == kLast && (poses == between || poses == start_but(1.0));
      const bool decoy = action == kOther && poses == start_but(1.0 + miss + 0.0625);
      if (action == kFirst && poses == task.start) return between;
      return last || decoy ? goal() : poses;
    };
  }
};

TEST(GenerateRounds, ThePolicyLearnsTheStepsOfChains) {
  TwoSteps world(0.1875);
  SearchConfig config = trees_only(4, 2);
  config.chain_share = 0.25;
  const GenerationReport report = world.generation(config);
  EXPECT_EQ(report.transitions, 4);
  EXPECT_EQ(report.tree_policy_success, 1.0);
  EXPECT_EQ(report.tree_policy_length_mean, 2.0);
}

TEST(GenerateRounds, ThePolicyLeavesOutStepsThatMissByMoreThanTheTolerance) {
  for (const double tolerance : {0.015, 0.016}) {
    TwoSteps world(0.015625);
    SearchConfig config = trees_only(3, 2);
    config.gap_tolerance = tolerance;
    const GenerationReport report = world.generation(config);
    EXPECT_EQ(report.transitions, 3);
    EXPECT_EQ(report.tree_policy_success, tolerance > 0.015625 ? 1.0 : 0.0);
  }
}

TEST(GenerateRounds, ThePolicyForgetsStepsThatFoundNoRoom) {
  ScriptedWorld world;
  world.task.horizon = 1;
  world.layers = {{{kFirst, world.start_but(1.0)}, {kLast, world.task.start}}};
  world.pushed = [&](const Poses&, int) { return world.goal(); };
  EXPECT_EQ(world.generation(trees_only(1, 1)).transitions, 1);  // one of two that are found
  ASSERT_EQ(world.replays.back().size(), 7U);
  for (const ReplayJob& job : world.replays.back()) EXPECT_EQ(job.action, world.stored[0].action);
}

TEST(GenerateRounds, MissesServeThePolicyOnlyIfTheyReachTheGoal) {
  ScriptedWorld world;
  world.task.horizon = 1;
  world.layers = {{{kFirst, world.start_but(1.0)}, {kLast, world.task.start}}};
  world.pushed = [&](Poses poses, int action) {
    if (action == kFirst) poses = world.goal();
    poses[0].x += 1.0;
    return poses;
  };
  const GenerationReport report = world.generation(trees_only(2, 1));
  EXPECT_EQ(report.transitions, 2);
  EXPECT_EQ(report.tree_policy_success, 1.0);  // by the one that begins farther away
}

TEST(GenerateRounds, ChainsNearestToTheStartAreReplayed) {
  ScriptedWorld world;
  const Poses near = world.start_but(0.0, 1.0), middle = world.start_but(0.0, 2.0),
              far = world.start_but(0.0, 3.0);
  world.layers = {{{kLast, far}}, {{kOther, middle}}, {{kFirst, near}}};
  world.pushed = [&](const Poses&, int action) {
    if (action == kFirst) return middle;
    return action == kOther ? far : world.goal();
  };
  SearchConfig config = trees_only(6, 3);
  config.chain_share = 0.5;
  world.generation(config);
  const std::vector<ReplayJob> begun{{near, kFirst}, {middle, kOther}};
  EXPECT_NE(std::ranges::find(world.replays, begun), world.replays.end());
}

TEST(GenerateRounds, PatienceIsHowManyLayersWithoutABetterNodeEndARound) {
  for (const int patience : {1, 3}) {
    ScriptedWorld world;
    for (int k = 1; k <= 6; ++k) world.layers.push_back({{kLast, world.start_but(0.0, k)}});
    world.pushed = [&](const Poses& poses, int) {
      const double up = poses[1].y - world.task.start[1].y;
      return up > 1.5 ? world.start_but(0.0, up - 1.0) : world.goal();
    };
    SearchConfig config = trees_only(1000, 6);
    config.patience = patience;
    world.generation(config);
    const auto layers = std::ranges::count_if(
        world.phases, [](const std::string& phase) { return phase.starts_with("round 1 ("); });
    EXPECT_EQ(layers, 1 + patience);
  }
}

struct JitterTest : ::testing::TestWithParam<bool> {};

TEST_P(JitterTest, EveryPhaseJittersItsStartsFromAStreamOfItsOwn) {
  const bool randomise = GetParam();
  ScriptedWorld world;
  world.task.horizon = 1;
  world.task.randomisation = 0.25;
  world.layers = {{{kFirst, world.task.start}}, {{kLast, world.start_but(1.0)}}};
  world.pushed = [&](const Poses&, int) { return world.goal(); };
  SearchConfig config = trees_only(102, 1);
  config.rollout_share = 100.0 / 102.0;
  config.target_jitter = 0.3;
  config.rollout_jitter = 0.2;
  config.randomise = randomise;
  world.generation(config);
  const double rollouts = randomise ? 0.25 : 0.2, judgement = randomise ? 0.25 : 0.1;
  const auto jittered = [&](Rng rng, double amplitude) {
    return world.begun_in(jittered_starts(world.task, 50, amplitude, rng));
  };
  Rng rng = ScriptedWorld::stream(4, 0);
  std::vector<Poses> judged;
  while (judged.size() < 7) judged.push_back(jittered_start(world.task, judgement, rng));
  // the first round has no policy to follow
  const std::vector<long> order{
      jittered(ScriptedWorld::stream(2, 1, ScriptedWorld::stream(1, 0).word()), 0.3),
      jittered(ScriptedWorld::stream(3, 0), rollouts), world.begun_in(judged),
      jittered(ScriptedWorld::stream(5, 0), rollouts),
      jittered(ScriptedWorld::stream(5, 1), rollouts)};
  EXPECT_GE(order.front(), 0);
  EXPECT_EQ(std::ranges::adjacent_find(order, std::greater_equal{}), order.end());
}

INSTANTIATE_TEST_SUITE_P(Randomise, JitterTest, ::testing::Bool());

TEST(GenerateRounds, ARoundHeadsForWhereThePolicyGotLost) {
  // From half of the starts `kFirst` throws the robot 6 m away, where the policy knows nothing.
  ScriptedWorld world;
  world.task.horizon = 2;
  const Poses start = world.task.start, there = world.start_but(4.5);
  world.layers = {{{kFirst, start}, {kLast, there}}};
  world.pushed = [&](Poses poses, int action) {
    if (action == kLast ? poses == there : poses[1].x >= start[1].x) return world.goal();
    poses[0].x += poses[0].x < 1.0 ? 6.0 : 0.0;
    return poses;
  };
  SearchConfig config = trees_only(3, 1);
  config.target_jitter = 0.0625;
  world.generation(config);
  ASSERT_GE(world.solves.size(), 2U);
  EXPECT_EQ(world.solves[1][0].end, there) << "of the nodes the nearest to the target comes first";
}

// Of two nodes the first has an object out of place by 0.15 m, the other one turned by 0.35 rad.
TEST(GenerateRounds, AnglesCountOnceThePolicySolvesAll) {
  for (const bool solves_all : {false, true}) {
    ScriptedWorld world;
    world.task.horizon = 1;
    const Poses start = world.task.start, moved = world.start_but(0.0, 0.15);
    Poses turned = start;
    turned[1] = to_single({turned[1].x, turned[1].y, turned[1].theta + 0.35});
    world.layers = {{{kFirst, moved}, {kLast, turned}}};
    world.pushed = [&](const Poses& poses, int) {
      return poses == start && !solves_all ? start : world.goal();
    };
    world.generation(trees_only(3, 1));
    ASSERT_GE(world.solves.size(), 2U);
    EXPECT_EQ(world.solves[1][0].end, solves_all ? moved : turned);
  }
}

struct RandomisedTest : ::testing::TestWithParam<ReverseMode> {};

TEST_P(RandomisedTest, EpisodesStartAllOverTheTasksRandomisation) {
  for (const bool randomise : {false, true}) {
    ScriptedWorld world;
    world.task.randomisation = 0.5;
    world.task.horizon = 1;
    world.pushed = [](const Poses& poses, int) { return poses; };
    SearchConfig config = trees_only(100, 1);
    config.reverse = GetParam();
    config.rollout_share = 0.5;
    config.rollout_jitter = 0.0;
    config.randomise = randomise;
    world.generation(config);
    double farthest = 0.0;
    for (const Transition& t : world.stored)
      if (t.source == Source::kRollOut)
        farthest = std::max(farthest, std::abs(t.poses[1].x - world.task.start[1].x));
    EXPECT_LE(farthest, randomise ? 0.5 : 0.0);
    EXPECT_GE(farthest, randomise ? 0.3 : 0.0);
  }
}

INSTANTIATE_TEST_SUITE_P(Reverse, RandomisedTest,
                         ::testing::Values(ReverseMode::kRrbs, ReverseMode::kRandom));

struct RollOutsTest : ::testing::TestWithParam<double> {};

/// Waves of 50, after the judgement of no policy at all.
TEST_P(RollOutsTest, FollowWhatEarlierOnesHaveFoundButForTheNoise) {
  ScriptedWorld world;
  world.task.horizon = 1;
  world.pushed = [&](const Poses& poses, int action) {
    return action == kLast ? world.goal() : poses;
  };
  SearchConfig config = trees_only(1000, 1);
  config.rollout_noise = GetParam();
  EXPECT_EQ(world.generation(config).transitions, 1000);
  const auto found = std::ranges::find_if(world.replays, [](const auto& wave) {
    return wave.size() == 50 && std::ranges::count(wave, kLast, &ReplayJob::action) > 0;
  });
  const auto waves = world.replays.end() - found - 1;
  ASSERT_GE(waves, 10);
  long noisy = 0;
  for (auto wave = found + 1; wave != world.replays.end(); ++wave)
    for (const ReplayJob& job : *wave) {
      EXPECT_LE(std::abs(job.action - kLast), config.rollout_noise > 0.0 ? 2 : 0);
      noisy += job.action != kLast;
    }
  // five standard deviations of 500 or more
  EXPECT_NEAR(static_cast<double>(noisy) / (50.0 * static_cast<double>(waves)), GetParam(), 0.11);
}

INSTANTIATE_TEST_SUITE_P(Noise, RollOutsTest, ::testing::Values(0.0, 0.4));

}  // namespace
}  // namespace rtg

#include "core/search/generate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/forward/box2d_simulator.hpp"
#include "core/search/coverage.hpp"
#include "tests/support/gathering.hpp"
#include "tests/support/generation_run.hpp"

namespace rtg {
namespace {

using testing::gathering;
using testing::GenerationRun;
using testing::run_naive;

SearchConfig small() {
  SearchConfig config;
  config.reverse = ReverseMode::kNaive;
  config.transitions = 3000;
  config.breadth = 8;
  config.explored = 2.0;
  config.depth = 12;
  config.mended = 0.1;
  config.twins = 2;  // these tests are not about how good the policy is
  config.evaluation_starts = 10;
  return config;
}

const GenerationRun& reference_run() {
  static const GenerationRun run = run_naive(gathering(), small(), 7, 1);
  return run;
}

bool same_reports(const GenerationReport& a, const GenerationReport& b) {
  GenerationReport x = a, y = b;
  x.reverse_cpu_s = y.reverse_cpu_s = 0.0;  // time is the one thing that may differ
  x.replay_cpu_s = y.replay_cpu_s = 0.0;
  x.generate_wall_s = y.generate_wall_s = 0.0;
  return to_json(x) == to_json(y);
}

TEST(Generate, GivesTheSameBytesForAnyNumberOfThreads) {
  for (const int threads : {2, 5}) {
    const GenerationRun run = run_naive(gathering(), small(), 7, threads);
    EXPECT_EQ(run.stored, reference_run().stored);
    EXPECT_TRUE(same_reports(run.report, reference_run().report));
  }
}

TEST(Generate, AnotherSeedGivesOtherTransitions) {
  EXPECT_NE(run_naive(gathering(), small(), 8, 2).stored, reference_run().stored);
}

TEST(Generate, StoresExactlyTheBudget) {
  EXPECT_EQ(reference_run().stored.size(), 3000U);
  EXPECT_EQ(reference_run().report.transitions, 3000);
  EXPECT_EQ(reference_run().progress.back().transitions, 3000);
}

TEST(Generate, EveryTransitionSimulatesToItselfAndIsLabelledByThePredicate) {
  const Task task = gathering();
  const Box2dSimulator simulator(task.scene, task.push, {});
  for (const Transition& t : reference_run().stored) {
    const PushOutcome outcome = simulator.push(t.poses, t.action);
    ASSERT_TRUE(outcome.ok);
    ASSERT_EQ(outcome.end, t.next);
    ASSERT_EQ(t.success, succeeded(task, t.next));
    ASSERT_FALSE(succeeded(task, t.poses)) << "a state that ends an episode starts no transition";
  }
}

TEST(Generate, TreesStoreNoStepTwice) {
  std::vector<Transition> steps;
  for (Transition t : reference_run().stored) {
    if (t.source == Source::kRollOut) continue;
    // A chain's first step would be one of these but for its source.
    t.source = Source::kStepReplay;
    steps.push_back(t);
  }
  for (std::size_t k = 0; k < steps.size(); ++k)
    for (std::size_t j = 0; j < k; ++j) ASSERT_NE(steps[j], steps[k]) << j << ", " << k;
}

TEST(Generate, EachSourceHasItsShare) {
  const auto count = [](Source source) {
    return std::ranges::count(reference_run().stored, source, &Transition::source);
  };
  EXPECT_EQ(count(Source::kRollOut), 1500);
  EXPECT_GT(count(Source::kChainReplay), 0);
  EXPECT_GT(count(Source::kMended), 0);
  EXPECT_GT(count(Source::kStepReplay), 450);  // those drawn at random
}

TEST(Generate, StepsOfChainsAndEpisodesFollowEachOther) {
  const std::vector<Transition>& all = reference_run().stored;
  long links = 0, steps = 0;
  for (std::size_t k = 1; k < all.size(); ++k) {
    if (all[k].source == Source::kStepReplay || all[k].source != all[k - 1].source) continue;
    ++steps;
    links += all[k].poses == all[k - 1].next;
  }
  EXPECT_GT(links, steps * 3 / 4);  // the rest begin a chain or an episode
}

TEST(Generate, ReportAgreesWithTheStoredTransitions) {
  const Task task = gathering();
  const GenerationReport& report = reference_run().report;
  long contacts = 0, several = 0, region = 0;
  for (const Transition& t : reference_run().stored) {
    int moved = 0;
    bool inside = true;
    for (std::size_t k = 1; k < t.poses.size(); ++k) {
      moved += std::hypot(t.next[k].x - t.poses[k].x, t.next[k].y - t.poses[k].y) > 0.05;
      inside = inside && std::abs(t.poses[k].x - task.start[k].x) <= 0.5 &&
               std::abs(t.poses[k].y - task.start[k].y) <= 0.5 &&
               std::abs(std::remainder(t.poses[k].theta - task.start[k].theta, M_PI / 2)) <= 0.35;
    }
    contacts += moved > 0;
    several += moved > 1;
    region += inside;
  }
  EXPECT_DOUBLE_EQ(report.contact_share, static_cast<double>(contacts) / 3000.0);
  EXPECT_DOUBLE_EQ(report.multi_body_share, static_cast<double>(several) / 3000.0);
  EXPECT_GT(several, 0);
  EXPECT_EQ(report.start_region_transitions, region);
  EXPECT_EQ(report.candidates, std::accumulate(report.statuses.begin(), report.statuses.end(), 0L));
}

TEST(Generate, CancelStopsIt) {
  const Task task = gathering();
  GenerationSeams seams = testing::naive_seams(task, 1);
  long stored = 0;
  seams.store = [&](std::span<const Transition> batch) {
    stored += static_cast<long>(batch.size());
  };
  seams.cancelled = [&] { return stored > 0; };
  const GenerationReport report = generate(task, small(), 7, seams);
  EXPECT_GT(report.transitions, 0);
  EXPECT_LT(report.transitions, 1000);
  EXPECT_EQ(report.transitions, stored);
}

TEST(Generate, EndsEvenIfNoReverseSolveConverges) {
  const Task task = gathering();
  GenerationSeams seams = testing::naive_seams(task, 1);
  seams.store = [](std::span<const Transition>) {};
  seams.solve = [](std::span<const ReverseJob> jobs) {
    return std::vector<ReverseResult>(jobs.size(), {SolveStatus::kIterationLimit, 50});
  };
  const GenerationReport report = generate(task, small(), 7, seams);
  EXPECT_EQ(report.transitions, 3000);  // episodes of random actions
  EXPECT_EQ(report.replay_gap_median, 0.0);
  EXPECT_EQ(report.tree_policy_success, 0.0);
}

/// A world of two pushes: `kSure` solves the task from anywhere, `kLucky` from `lucky()` only.
/// Reverse solves find the first in the first round and the second, nearer to the start, later.
struct LuckyWorld {
  static constexpr int kSure = 0, kLucky = 5;
  Task task = gathering();
  int rounds = 0;
  double turn = 0.0;  // of the objects, by a push that solves the task [rad]

  LuckyWorld() { task.horizon = 1; }

  Poses beside_the_start(double x) const {
    Poses out = task.start;
    out[0].x += x;
    return out;
  }
  Poses lucky() const { return beside_the_start(0.125); }

  Poses pushed(const ReplayJob& job) const {
    Poses end = job.start;
    if (job.action == kSure || (job.action == kLucky && job.start == lucky()))
      for (std::size_t k = 1; k < end.size(); ++k) end[k] = {0.0, 0.0, end[k].theta + turn};
    return end;
  }

  GenerationSeams seams() {
    GenerationSeams out;
    out.solve = [this](std::span<const ReverseJob> jobs) {
      ++rounds;
      std::vector<ReverseResult> results(jobs.size(), {SolveStatus::kPruned});
      for (std::size_t k = 0; k < jobs.size(); ++k)
        if (jobs[k].action == (rounds == 1 ? kSure : kLucky))
          results[k] = {
              SolveStatus::kConverged, 1, {rounds == 1 ? beside_the_start(0.5) : lucky()}};
      return results;
    };
    out.replay = [this](std::span<const ReplayJob> jobs) {
      std::vector<ReplayResult> results;
      for (const ReplayJob& job : jobs) results.push_back({pushed(job), true, 0.0});
      return results;
    };
    out.store = [](std::span<const Transition>) {};
    return out;
  }
};

/// Two rounds of one transition each.
SearchConfig two_steps() {
  SearchConfig config = small();
  config.transitions = 2;
  config.explored = 1.0;
  config.mended = 0.0;
  config.depth = 1;
  config.twins = 0;  // luck stretches errors without bound; here the policy has to find that out
  config.rollout_share = 0.0;
  return config;
}

TEST(Generate, ThePolicyLeavesOutPushesThatTurnAnObjectFar) {
  for (const double turn : {0.2, 0.4}) {
    LuckyWorld world;
    world.turn = turn;
    SearchConfig config = two_steps();
    config.turn_tolerance = 0.3;
    config.evaluation_starts = 100;
    const GenerationReport report = generate(world.task, config, 1, world.seams());
    EXPECT_EQ(report.transitions, 2);
    if (turn < config.turn_tolerance) {
      EXPECT_EQ(report.tree_policy_success, 1.0);
    } else {
      EXPECT_LT(report.tree_policy_success, 0.2);  // random actions, of which one in 48 succeeds
    }
  }
}

TEST(Generate, ARoundThatMakesThePolicyWorseDoesNotDecide) {
  LuckyWorld world;
  const SearchConfig config = two_steps();
  const GenerationReport report = generate(world.task, config, 1, world.seams());
  EXPECT_EQ(world.rounds, 2);
  EXPECT_EQ(report.transitions, 2);
  EXPECT_DOUBLE_EQ(report.tree_policy_success, 1.0);
}

}  // namespace
}  // namespace rtg

#include "core/search/walks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "core/forward/box2d_simulator.hpp"
#include "tests/support/gathering.hpp"
#include "tests/support/generation_run.hpp"

namespace rtg::search {
namespace {

using testing::gathering;
using testing::GenerationRun;
using testing::run_naive;

/// Walks without branches: as they were walked.
SearchConfig walks(Generator generator) {
  SearchConfig config;
  config.generator = generator;
  config.transitions = 4000;
  config.branches = 0;
  return config;
}

const GenerationRun& random_run() {
  static const GenerationRun run = run_naive(gathering(), walks(Generator::kRandom), 7, 1);
  return run;
}

const GenerationRun& scatter_run() {
  static const GenerationRun run = run_naive(gathering(), walks(Generator::kScatter), 7, 1);
  return run;
}

/// States in which a stored walk begins: no stored step ends there.
std::vector<Poses> origins(const GenerationRun& run) {
  std::vector<Poses> out;
  for (const Transition& t : run.stored)
    if (std::ranges::find(run.stored, t.poses, &Transition::next) == run.stored.end())
      out.push_back(t.poses);
  return out;
}

TEST(Walks, GiveTheSameBytesForAnyNumberOfThreads) {
  for (const Generator generator : {Generator::kRandom, Generator::kScatter}) {
    const std::vector<Transition> one = run_naive(gathering(), walks(generator), 7, 1).stored;
    EXPECT_EQ(run_naive(gathering(), walks(generator), 7, 3).stored, one);
    EXPECT_NE(run_naive(gathering(), walks(generator), 8, 1).stored, one);
  }
}

TEST(Walks, StoreExactlyTheBudgetWithoutReverseSteps) {
  const GenerationReport& report = random_run().report;
  EXPECT_EQ(random_run().stored.size(), 4000U);
  EXPECT_EQ(report.coverage.transitions, 4000);
  EXPECT_EQ(report.stats.candidates, 0);
  EXPECT_TRUE(report.starts.empty());
  EXPECT_EQ(random_run().progress.back().transitions, 4000);
}

TEST(Walks, AreTrueTransitionsThatEndWithinTheHorizonAndStartWhereTheGoalDoesNotHold) {
  const tasks::Task task = gathering();
  const forward::Box2dSimulator simulator(task.scene, task.push, {});
  for (const GenerationRun* run : {&random_run(), &scatter_run()})
    for (const Transition& t : run->stored) {
      const forward::PushOutcome outcome = simulator.push(t.poses, t.action);
      ASSERT_TRUE(outcome.ok);
      ASSERT_EQ(outcome.end, t.next);
      ASSERT_EQ(t.success, succeeded(task, t.next));
      ASSERT_FALSE(succeeded(task, t.poses));
      ASSERT_EQ(t.source, Source::kWalk);
    }
}

TEST(Walks, BeginAtJitteredStarts) {
  const tasks::Task task = gathering();
  const std::vector<Poses> begun = origins(random_run());
  EXPECT_GE(begun.size(), 100U);  // two waves
  for (const Poses& start : begun)
    for (std::size_t i = 1; i < start.size(); ++i)
      EXPECT_LE((start[i].position() - task.start[i].position()).lpNorm<Eigen::Infinity>(),
                task.start_jitter + 1e-6);
}

TEST(Walks, OrScatterFromGoalStates) {
  const tasks::Task task = gathering();
  // The first stored step begins where a walk has left the goal, a push or more away from it.
  double nearest = 1e9;
  for (const Poses& begun : origins(scatter_run()))
    for (std::size_t i = 1; i < begun.size(); ++i)
      nearest = std::min(nearest, begun[i].position().norm());
  EXPECT_LT(nearest, 2.0);
}

TEST(Walks, AreAsLongAsAnEpisodeOrFromGoalStatesSixPushes) {
  const tasks::Task task = gathering();
  for (const auto& [generator, pushes] :
       {std::pair(Generator::kRandom, task.horizon), std::pair(Generator::kScatter, 6)}) {
    int calls = 0;
    GenerationSeams seams;
    seams.replay = [&](std::span<const ReplayJob> jobs) {
      calls += !jobs.empty();
      std::vector<ReplayResult> results;
      for (const ReplayJob& job : jobs) results.push_back({job.start, true});
      return results;
    };
    seams.store = [](std::span<const Transition>) {};
    seams.cancelled = [&] { return calls > 0; };  // after the first wave
    generate(task, walks(generator), 7, seams);
    EXPECT_EQ(calls, pushes);
  }
}

TEST(Walks, MoveObjectsFarMoreOftenThanUniformPushesDo) {
  EXPECT_GT(random_run().report.coverage.contact_share, 0.25);
  EXPECT_LT(random_run().report.coverage.contact_share, 0.75);
}

TEST(Walks, HaveBranchesAsAllStepsDo) {
  SearchConfig config = walks(Generator::kRandom);
  config.branches = 4;
  const GenerationRun run = run_naive(gathering(), config, 7, 1);
  EXPECT_NEAR(run.report.coverage.of(Source::kBranch), 3200, 20);
  EXPECT_NEAR(run.report.coverage.headings_per_state, 5.0, 0.1);
}

TEST(Walks, EndWithAPushThatTheSimulatorRejects) {
  const tasks::Task task = gathering();
  GenerationSeams seams;
  long calls = 0;
  std::vector<Transition> stored;
  seams.replay = [&](std::span<const ReplayJob> jobs) {
    calls += !jobs.empty();
    return std::vector<ReplayResult>(jobs.size());  // none is finished
  };
  seams.store = [&](std::span<const Transition> rows) {
    stored.insert(stored.end(), rows.begin(), rows.end());
  };
  const GenerationReport report = generate(task, walks(Generator::kRandom), 7, seams);
  EXPECT_TRUE(stored.empty());
  EXPECT_EQ(calls, 8) << "it gives up";
  EXPECT_EQ(report.stats.rejected_pushes, 8 * 50);
}

}  // namespace
}  // namespace rtg::search

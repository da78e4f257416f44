#include "core/search/random_episodes.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/forward/box2d_simulator.hpp"
#include "tests/support/gathering.hpp"
#include "tests/support/generation_run.hpp"

namespace rtg {
namespace {

using testing::gathering;
using testing::GenerationRun;
using testing::run_naive;

SearchConfig random_data() {
  SearchConfig config;
  config.reverse = ReverseMode::kRandom;
  config.transitions = 4000;
  return config;
}

const GenerationRun& reference_run() {
  static const GenerationRun run = run_naive(gathering(), random_data(), 7, 1);
  return run;
}

TEST(RandomEpisodes, GiveTheSameBytesForAnyNumberOfThreads) {
  EXPECT_EQ(run_naive(gathering(), random_data(), 7, 3).stored, reference_run().stored);
  EXPECT_NE(run_naive(gathering(), random_data(), 8, 1).stored, reference_run().stored);
}

TEST(RandomEpisodes, StoreExactlyTheBudgetAndCountIt) {
  const GenerationReport& report = reference_run().report;
  EXPECT_EQ(reference_run().stored.size(), 4000U);
  EXPECT_EQ(report.transitions, 4000);
  EXPECT_GT(report.contact_share, 0.02);
  EXPECT_LT(report.contact_share, 0.3);
  EXPECT_EQ(report.candidates, 0) << "there is no reverse step";
  EXPECT_EQ(reference_run().progress.back().transitions, 4000);
}

TEST(RandomEpisodes, AreTrueEpisodesFromTheStart) {
  const Task task = gathering();
  const Box2dSimulator simulator(task.scene, task.push, {});
  const std::vector<Transition>& all = reference_run().stored;
  int length = 0;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const Transition& t = all[k];
    const PushOutcome outcome = simulator.push(t.poses, t.action);
    ASSERT_TRUE(outcome.ok);
    ASSERT_EQ(outcome.end, t.next);
    ASSERT_EQ(t.success, succeeded(task, t.next));
    ASSERT_EQ(t.source, Source::kRollOut);
    const bool goes_on = k > 0 && !all[k - 1].success && length < task.horizon;
    if (goes_on) {
      ASSERT_EQ(t.poses, all[k - 1].next);
    } else {
      for (std::size_t i = 1; i < t.poses.size(); ++i)
        ASSERT_LE((t.poses[i].position() - task.start[i].position()).lpNorm<Eigen::Infinity>(),
                  0.25 + 1e-6);
      length = 0;
    }
    ++length;
  }
}

TEST(RandomEpisodes, TakeEveryHeadingAlike) {
  std::vector<int> counts(48);
  for (const Transition& t : reference_run().stored) ++counts[static_cast<std::size_t>(t.action)];
  const double mean = 4000.0 / 48.0;  // standard deviation 9
  EXPECT_GT(*std::ranges::min_element(counts), mean - 45.0);
  EXPECT_LT(*std::ranges::max_element(counts), mean + 45.0);
}

TEST(RandomEpisodes, EndWithAPushThatTheSimulatorRejects) {
  const Task task = gathering();
  GenerationSeams seams;
  long calls = 0;
  std::vector<Transition> stored;
  seams.replay = [&](std::span<const ReplayJob> jobs) {
    ++calls;
    return std::vector<ReplayResult>(jobs.size());  // none is finished
  };
  seams.store = [&](std::span<const Transition> rows) {
    stored.insert(stored.end(), rows.begin(), rows.end());
  };
  const GenerationReport report = random_episodes(task, random_data(), 7, seams);
  EXPECT_TRUE(stored.empty());
  EXPECT_EQ(calls, 8) << "it gives up";
  EXPECT_EQ(report.rejected_pushes, 8 * 50);
}

}  // namespace
}  // namespace rtg

#include "core/search/generate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <regex>
#include <set>
#include <string>

#include "core/forward/box2d_simulator.hpp"
#include "core/search/generation.hpp"
#include "core/search/predecessor.hpp"
#include "core/search/state_metric.hpp"
#include "tests/support/gathering.hpp"
#include "tests/support/generation_run.hpp"

namespace rtg::search {
namespace {

using testing::gathering;
using testing::GenerationRun;
using testing::run_naive;

constexpr int kBudget = 3000;

SearchConfig small() {
  SearchConfig config;
  config.generator = Generator::kNaive;
  config.transitions = kBudget;
  config.breadth = 10;  // so that a tree reaches its start
  config.depth = 20;
  return config;
}

const GenerationRun& reference_run() {
  static const GenerationRun run = run_naive(gathering(), small(), 7, 1);
  return run;
}

bool same_reports(const GenerationReport& a, const GenerationReport& b) {
  GenerationReport x = a, y = b;
  x.stats.times = y.stats.times = {};  // time is the one thing that may differ
  x.generate_wall_s = y.generate_wall_s = 0.0;
  x.generate_cpu_s = y.generate_cpu_s = 0.0;
  return to_json(x) == to_json(y);
}

TEST(Generate, GivesTheSameBytesForAnyNumberOfThreads) {
  for (const int threads : {2, 5}) {
    const GenerationRun run = run_naive(gathering(), small(), 7, threads);
    EXPECT_EQ(run.stored, reference_run().stored);
    EXPECT_TRUE(same_reports(run.report, reference_run().report));
  }
}

// So each shard may be found by another machine.
TEST(Generate, ShardsFindWhatEachOfThemFindsAlone) {
  SearchConfig whole = small();
  whole.transitions = 1003;
  whole.shards = 3;
  std::vector<Transition> expected;
  SearchStats stats;
  std::size_t trees = 0;
  for (int k = 0; k < whole.shards; ++k) {
    SearchConfig alone = small();
    alone.transitions = share_of_shard(whole, k);
    alone.shard = k;
    const GenerationRun run = run_naive(gathering(), alone, 7, 2);
    EXPECT_EQ(run.stored.size(), k == 2 ? 335U : 334U);
    expected.insert(expected.end(), run.stored.begin(), run.stored.end());
    stats.replays += run.report.stats.replays;
    trees += run.report.starts.size();
  }
  const GenerationRun run = run_naive(gathering(), whole, 7, 1);
  EXPECT_EQ(run.stored, expected);
  EXPECT_EQ(run.report.stats.replays, stats.replays);
  EXPECT_EQ(run.report.starts.size(), trees);
  EXPECT_TRUE(run.report.shortfalls.empty());
}

// A narrow tree would leave most of many workers idle.
TEST(Generate, GrowsTreesTogetherAfterTheFirst) {
  SearchConfig config = small();
  config.transitions = 2500;
  config.breadth = 4;
  config.branches = 0;
  std::set<std::size_t> batches;  // their sizes
  GenerationSeams seams = testing::naive_seams(gathering(), 1);
  seams.solve = [&batches, solve = seams.solve](std::span<const reverse::ReverseJob> jobs) {
    batches.insert(jobs.size());
    return solve(jobs);
  };
  const GenerationRun run = testing::run(gathering(), config, 7, seams);
  const auto first_with = [&run](const std::string& phase) {
    return std::ranges::count_if(run.progress, [&](const Progress& p) {
      return p.layer == 1 && p.phase.starts_with(phase);
    });
  };
  EXPECT_EQ(first_with("tree 1"), 1);
  EXPECT_EQ(first_with("trees 2 to "), 1);
  EXPECT_GT(*batches.rbegin(), 2U * 4U * 48U);
  // As many trees as there are transitions left for: hardly one ends half grown.
  EXPECT_GE(starts_reached(run.report.starts) + 2, static_cast<long>(run.report.starts.size()));
  const Generation again{gathering(), config, 7, seams};
  for (std::size_t k = 0; k < run.report.starts.size(); ++k) {
    Rng rng = again.attempt_rng(static_cast<int>(k));
    EXPECT_EQ(run.report.starts[k].poses, again.draw_start(rng));
  }
}

TEST(Generate, AnotherSeedGivesOtherTransitions) {
  EXPECT_NE(run_naive(gathering(), small(), 8, 2).stored, reference_run().stored);
}

/// The attempts that repeat() makes, `together` at a time, where every `period`-th one stores a
/// transition, `budget` all.
int attempts(int period, int budget, int together = 1) {
  const tasks::Task task = gathering();
  SearchConfig config = small();
  config.transitions = budget;
  config.branches = 0;
  const ReplayBatch none = [](std::span<const ReplayJob>) { return std::vector<ReplayResult>(); };
  const GenerationSeams seams{{}, none, [](std::span<const Transition>) {}};
  Generation run{task, config, 7, seams};
  int made = 0;
  run.repeat([&](int number) {
    EXPECT_EQ(number, made);
    made += together;
    if (made % period != 0) return together;
    const Transition step{testing::robot_at(made), 0, testing::robot_at(made + 1)};
    run.data.store({&step, 1}, none);
    return together;
  });
  return made;
}

TEST(Generate, EndsAfterEightAttemptsInARowThatStoreNothing) {
  EXPECT_EQ(attempts(5, 20), 100);
  EXPECT_EQ(attempts(8, 20), 160);
  EXPECT_EQ(attempts(9, 20), 8);
  EXPECT_EQ(attempts(9, 20, 4), 8);
}

TEST(Generate, StoresExactlyTheBudget) {
  EXPECT_EQ(reference_run().stored.size(), std::size_t{kBudget});
  EXPECT_EQ(reference_run().report.coverage.transitions, kBudget);
  EXPECT_EQ(reference_run().progress.back().transitions, kBudget);
}

TEST(Generate, EveryTransitionSimulatesToItselfAndIsLabelledByThePredicate) {
  const tasks::Task task = gathering();
  const forward::Box2dSimulator simulator(task.scene, task.push, {});
  for (const Transition& t : reference_run().stored) {
    const forward::PushOutcome outcome = simulator.push(t.poses, t.action);
    ASSERT_TRUE(outcome.ok);
    ASSERT_EQ(outcome.end, t.next);
    ASSERT_EQ(t.success, succeeded(task, t.next));
    ASSERT_FALSE(succeeded(task, t.poses)) << "a state that ends an episode starts no transition";
  }
}

TEST(Generate, StoresNothingTwice) {
  std::set<std::uint64_t> keys;
  for (const Transition& t : reference_run().stored)
    keys.insert(reverse::key_of(t.poses, t.action));
  EXPECT_EQ(keys.size(), reference_run().stored.size());
}

TEST(Generate, EveryTreeStepIsFollowedByItsBranches) {
  const std::vector<Transition>& all = reference_run().stored;
  long trees = 0, behind = 0;  // branches since the last step of a tree
  for (std::size_t k = 0; k < all.size(); ++k) {
    const bool is_step = all[k].source == Source::kTree;
    trees += is_step;
    behind = is_step ? 0 : behind + 1;
    ASSERT_TRUE(is_step || all[k].source == Source::kBranch);
    ASSERT_LE(behind, 4);
    ASSERT_TRUE(is_step || all[k].poses == all[k - 1].poses);
  }
  EXPECT_NEAR(trees, kBudget / 5, 15) << "of a few nothing is new";
  EXPECT_EQ(reference_run().report.coverage.of(Source::kTree), trees);
  EXPECT_EQ(reference_run().report.coverage.of(Source::kBranch), kBudget - trees);
  EXPECT_GE(reference_run().report.coverage.headings_per_state, 4.9);
}

TEST(Generate, EachTreeGrowsFromGoalStatesToAStartOfItsOwn) {
  tasks::Task task = gathering();
  task.start_jitter = 1.5;
  SearchConfig config = small();
  config.transitions = 800;
  config.breadth = 20;
  config.branches = 0;
  config.plans_per_node = 1;
  config.whole_plan_share = 0.0;
  config.depth = 24;
  const GenerationReport report = run_naive(task, config, 7, 1).report;
  ASSERT_GE(report.starts.size(), 2U);
  double apart = 0.0, away[] = {0.0, 0.0};  // sums over the boxes
  for (std::size_t box = 1; box <= 3; ++box) {
    const Vector2d other = report.starts[1].poses[box].position();
    apart += (report.starts[0].poses[box].position() - other).norm();
    for (const std::size_t tree : {0U, 1U}) away[tree] += report.starts[tree].away[box];
  }
  for (const std::size_t tree : {0U, 1U}) {
    Rng rng(Rng(7).word(), tree);
    EXPECT_EQ(report.starts[tree].poses, jittered_start(task, task.start_jitter, rng));
    EXPECT_LT(away[tree], apart / 4.0);
  }
  EXPECT_TRUE(succeeded(task, report.nodes[0].poses));
}

TEST(Generate, ATreeEndsAtItsDepth) {
  SearchConfig config = small();
  config.depth = 3;
  config.transitions = 1000;
  const GenerationReport report = run_naive(gathering(), config, 7, 1).report;
  EXPECT_GT(report.starts.size(), 1U);
  for (const ReportNode& n : report.nodes) EXPECT_LE(n.depth, 3);
}

/// Layers of the first tree.
int layers(const SearchConfig& config, GenerationSeams seams) {
  int found = 0;
  bool ended = false;
  seams.store = [](std::span<const Transition>) {};
  seams.progress = [&](const Progress& p) {
    if (p.phase == "tree 1") found = p.layer;
    ended = p.phase != "tree 1";
  };
  seams.cancelled = [&] { return ended; };
  generate(gathering(), config, 7, seams);
  return found;
}

TEST(Generate, ATreeThatComesNoNearerEndsWithItsPatience) {
  SearchConfig config = small();
  config.transitions = 100000;
  config.depth = 200;
  const GenerationSeams seams = testing::naive_seams(gathering(), 1);
  config.patience = 1;
  const int first = layers(config, seams);  // the first that comes no nearer
  config.patience = 3;
  EXPECT_GE(layers(config, seams), first + 2);
  EXPECT_LT(layers(config, seams), config.depth);
}

// Steps that move no object come as near to the start as the tree's roots and no nearer.
TEST(Generate, ATreeThatStaysAsNearAsItIsEndsWithItsPatience) {
  SearchConfig config = small();
  config.transitions = 100000;
  config.patience = 3;
  GenerationSeams seams = testing::naive_seams(gathering(), 1);
  const SolveBatch naive = seams.solve;
  seams.solve = [&](std::span<const reverse::ReverseJob> jobs) {
    std::vector<reverse::ReverseResult> answers = naive(jobs);
    for (std::size_t k = 0; k < jobs.size(); ++k)
      std::erase_if(answers[k].predecessors,
                    [&](const Poses& p) { return objects_moved(p, jobs[k].end) > 0; });
    return answers;
  };
  EXPECT_LT(layers(config, seams), 6);
}

TEST(Generate, ATreeEndsWhereNothingLeadsToIt) {
  GenerationSeams seams = testing::naive_seams(gathering(), 1);
  seams.solve = [](std::span<const reverse::ReverseJob> jobs) {
    return std::vector<reverse::ReverseResult>(jobs.size(), {reverse::SolveStatus::kPruned});
  };
  EXPECT_EQ(layers(small(), seams), 1);
}

TEST(Generate, ReportAgreesWithTheStoredTransitions) {
  const tasks::Task task = gathering();
  const GenerationReport& report = reference_run().report;
  long contacts = 0, several = 0;
  for (const Transition& t : reference_run().stored) {
    int moved = 0;
    for (std::size_t k = 1; k < t.poses.size(); ++k)
      moved += std::hypot(t.next[k].x - t.poses[k].x, t.next[k].y - t.poses[k].y) > 0.05;
    contacts += moved > 0;
    several += moved > 1;
  }
  EXPECT_DOUBLE_EQ(report.coverage.contact_share, static_cast<double>(contacts) / kBudget);
  EXPECT_DOUBLE_EQ(report.coverage.multi_body_share, static_cast<double>(several) / kBudget);
  EXPECT_GT(several, 0);
  EXPECT_EQ(report.stats.candidates,
            std::accumulate(report.stats.statuses.begin(), report.stats.statuses.end(), 0L));
}

TEST(Generate, CancelStopsIt) {
  const tasks::Task task = gathering();
  GenerationSeams seams = testing::naive_seams(task, 1);
  long stored = 0;
  seams.store = [&](std::span<const Transition> batch) {
    stored += static_cast<long>(batch.size());
  };
  seams.cancelled = [&] { return stored > 0; };
  const GenerationReport report = generate(task, small(), 7, seams);
  EXPECT_GT(report.coverage.transitions, 0);
  EXPECT_LT(report.coverage.transitions, kBudget / 2);
  EXPECT_EQ(report.coverage.transitions, stored);
}

TEST(Generate, EndsEvenIfNoReverseSolveConverges) {
  const tasks::Task task = gathering();
  GenerationSeams seams = testing::naive_seams(task, 1);
  seams.store = [](std::span<const Transition>) {};
  seams.solve = [](std::span<const reverse::ReverseJob> jobs) {
    return std::vector<reverse::ReverseResult>(jobs.size(),
                                               {reverse::SolveStatus::kIterationLimit, 50});
  };
  const GenerationReport report = generate(task, small(), 7, seams);
  EXPECT_EQ(report.coverage.transitions, 0);
  EXPECT_EQ(report.starts.size(), 8U) << "then it gives up";
  EXPECT_TRUE(report.stats.gaps.empty());
}

TEST(Generate, TellsWhyGoalStatesWereDrawnInVain) {
  tasks::Task task = gathering();
  task.goal = testing::near_origin(0.04);  // no room for three
  GenerationSeams seams = testing::naive_seams(task, 1);
  seams.store = [](std::span<const Transition>) {};
  const GenerationReport report = generate(task, small(), 7, seams);
  EXPECT_TRUE(report.starts.empty());
  EXPECT_TRUE(std::regex_match(report.undrawn_reason,
                               std::regex("'box.' was nearer to 'box.' than the clearance in "
                                          "[0-9]+% of the failed tries")))
      << report.undrawn_reason;
}

TEST(Generate, WithRandomiseTreesAndWalksHaveStartsAllOverTheTasksRandomisation) {
  tasks::Task task = gathering();
  task.start_jitter = 0.25;  // what is in place in a tree is moved no farther
  tasks::Task wide = task;
  wide.start_jitter = task.randomisation;
  ASSERT_GT(wide.start_jitter, task.start_jitter);
  for (const Generator generator : {Generator::kNaive, Generator::kRandom}) {
    SearchConfig config = small();
    config.generator = generator;
    const std::vector<Transition> near = run_naive(task, config, 7, 1).stored;
    const std::vector<Transition> all_over = run_naive(wide, config, 7, 1).stored;
    config.randomise = true;
    EXPECT_EQ(run_naive(task, config, 7, 1).stored, all_over);
    EXPECT_NE(near, all_over);
    task.randomisation = 0.1;  // less than start_jitter, which holds then
    EXPECT_EQ(run_naive(task, config, 7, 1).stored, near);
    task.randomisation = wide.randomisation;
  }
}

}  // namespace
}  // namespace rtg::search

#include "nodes/jobs/journaled.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <random>

#include "tests/support/folder.hpp"
#include "tests/support/gathering.hpp"
#include "tests/support/generation_run.hpp"

namespace rtg::jobs {
namespace {

constexpr std::uint64_t kSeed = 7;
constexpr std::int64_t kGeneration = 3;

search::SearchConfig small(search::Generator generator) {
  search::SearchConfig config;
  config.generator = generator;
  config.transitions = generator == search::Generator::kNaive ? 1200 : 60;
  config.breadth = 6;
  config.depth = 10;
  return config;
}

struct Killed {};

/// A generation with a journal in `folder`.
struct Journaled {
  const tasks::Task task = testing::gathering();
  const TaskShape shape{static_cast<int>(task.scene.size()), action_count(task.push)};
  search::SearchConfig config;
  std::filesystem::path file;
  long computed = 0;  // jobs, of the last run
  int batches = 0;    // of the last run

  Journaled(search::Generator generator, const testing::Folder& folder)
      : config(small(generator)), file(folder.path / "journal") {}

  /// Generates until the batch number `last` is asked for; that one throws Killed.
  testing::GenerationRun run(int last, int threads = 1) {
    UnitJournal journal(file, kGeneration);
    search::GenerationSeams seams = testing::seams_of(task, config.generator, threads);
    computed = batches = 0;
    const auto killed = [&](auto whole) {
      return [&, whole](auto jobs) {
        if (batches++ == last) throw Killed();
        computed += std::ssize(jobs);
        return whole(jobs);
      };
    };
    seams.solve = killed(seams.solve);
    seams.replay = killed(seams.replay);
    keep_in(journal, shape, seams);
    return testing::run(task, config, kSeed, seams);
  }
};

void expect_equal(const testing::GenerationRun& found, const testing::GenerationRun& undisturbed) {
  EXPECT_EQ(found.stored, undisturbed.stored);
  EXPECT_EQ(found.report.stats.iterations, undisturbed.report.stats.iterations);
  EXPECT_EQ(found.report.stats.gaps, undisturbed.report.stats.gaps);
  EXPECT_EQ(found.report.stats.replays, undisturbed.report.stats.replays);
}

class JournaledGeneration : public ::testing::TestWithParam<search::Generator> {};

TEST_P(JournaledGeneration, KilledTwentyTimesItFindsTheSameTransitions) {
  const testing::Folder folder;
  Journaled generation(GetParam(), folder);
  const testing::GenerationRun undisturbed = generation.run(-1);
  const long all = generation.computed;
  std::filesystem::remove(generation.file);
  std::mt19937 random(1);
  std::uniform_int_distribution last(0, generation.batches - 1);
  std::uintmax_t before = 0;  // end of the journal; what is written after it may be torn
  int killed = 0;             // not where the journal leaves too few batches
  for (int kill = 0; kill < 20; ++kill) {
    try {
      generation.run(last(random), 1 + kill % 3);
    } catch (const Killed&) {
      ++killed;
    }
    const std::uintmax_t end = std::filesystem::file_size(generation.file);
    std::uniform_int_distribution<std::uintmax_t> torn(std::min(before, end), end);
    before = torn(random);
    std::filesystem::resize_file(generation.file, before);
  }
  EXPECT_GT(killed, 10);
  const testing::GenerationRun resumed = generation.run(-1);
  expect_equal(resumed, undisturbed);
  EXPECT_LT(generation.computed, all);
}

TEST_P(JournaledGeneration, FindsWhatOneWithoutAJournalFinds) {
  const testing::Folder folder;
  Journaled generation(GetParam(), folder);
  expect_equal(generation.run(-1), testing::run(generation.task, generation.config, kSeed,
                                                testing::seams_of(generation.task, GetParam(), 1)));
}

TEST_P(JournaledGeneration, AWholeJournalLeavesNothingToCompute) {
  const testing::Folder folder;
  Journaled generation(GetParam(), folder);
  const testing::GenerationRun first = generation.run(-1);
  EXPECT_GT(generation.computed, 0);
  const testing::GenerationRun again = generation.run(-1, 2);
  EXPECT_EQ(generation.computed, 0);
  expect_equal(again, first);
  for (std::size_t k = 0; k < first.report.stats.times.size(); ++k)
    EXPECT_DOUBLE_EQ(again.report.stats.times[k].cpu_s, first.report.stats.times[k].cpu_s);
}

INSTANTIATE_TEST_SUITE_P(Generators, JournaledGeneration,
                         ::testing::Values(search::Generator::kNaive, search::Generator::kRrbs,
                                           search::Generator::kForward));

TEST(Journaled, AnAnswerThatIsIllegalOrGivenUpIsComputed) {
  const testing::Folder folder;
  const TaskShape shape{.bodies = 1, .actions = 48};
  const std::vector<search::ReplayJob> jobs{{{{1.0, 2.0, 3.0}}, 4}, {{{5.0, 6.0, 7.0}}, 8}};
  const JobId id = unit_id(std::span(jobs), kGeneration);
  UnitJournal journal(folder.path / "journal", kGeneration);
  int asked = 0;
  const search::ReplayBatch replay = [&](std::span<const search::ReplayJob> some) {
    asked += some.empty() ? 0 : 1;
    std::vector<search::ReplayResult> results;
    for (const search::ReplayJob& job : some) results.push_back({job.start, true, 0.5});
    return results;
  };
  const search::ReplayBatch kept = journaled<ReplayService>(replay, journal, shape);
  const auto expect_asked = [&](int times) {
    for (const int expected : {times, times}) {
      EXPECT_EQ(kept(jobs)[1].end, jobs[1].start);
      EXPECT_EQ(asked, expected);
    }
  };
  journal.add_given_up(id);
  expect_asked(1);
  journal.add(id, ReplayService::message(std::vector<search::ReplayResult>{{jobs[0].start}}));
  expect_asked(2);  // one result is too few
  journal.add(id, ReverseService::message(std::vector<reverse::ReverseResult>(2)));
  expect_asked(3);
  auto illegal = ReplayService::message(replay(jobs));
  illegal.ok[1] = 7;
  --asked;
  journal.add(id, illegal);
  expect_asked(4);
  EXPECT_EQ(journal.cpu_s_found(), 4.0);
}

TEST(Piece, IsAsLongAsTheLongestThatWasQuick) {
  Piece piece;
  for (int k = 0; k < 100; ++k) piece.took(Piece::kLeast - 1, 0.001);
  EXPECT_EQ(piece.units(), Piece::kLeast);
  piece.took(Piece::kLeast, 0.001);
  EXPECT_EQ(piece.units(), 2 * Piece::kLeast);
  for (int k = 0; k < 100; ++k) piece.took(Piece::kLeast, 3.0);
  EXPECT_EQ(piece.units(), Piece::kLeast);
}

// A piece that grew after each quick batch had no unit any more after sixty of them: a run of many
// small layers never ended.
TEST(Journaled, ManyQuickBatchesAreAllAnswered) {
  const testing::Folder folder;
  const TaskShape shape{.bodies = 1, .actions = 48};
  UnitJournal journal(folder.path / "journal", kGeneration);
  int empty = 0;
  const search::ReplayBatch replay = [&](std::span<const search::ReplayJob> some) {
    if (some.empty() && ++empty > 3) throw std::logic_error("asked again and again for nothing");
    std::vector<search::ReplayResult> results;
    for (const search::ReplayJob& job : some) results.push_back({job.start, true, 0.5});
    return results;
  };
  const search::ReplayBatch kept = journaled<ReplayService>(replay, journal, shape);
  for (int k = 0; k < 100; ++k)
    EXPECT_EQ(kept(std::vector<search::ReplayJob>{{{{1.0 * k, 2.0, 3.0}}, 4}}).size(), 1);
}

TEST(Journaled, AKillWithinABatchLosesThePieceUnderWayAlone) {
  const testing::Folder folder;
  const TaskShape shape{.bodies = 1, .actions = 48};
  constexpr std::size_t kUnits = 2 * Piece::kLeast + 3;
  std::vector<search::ReplayJob> jobs(kUnits * ReplayService::kUnit.jobs);
  for (std::size_t k = 0; k < jobs.size(); ++k)
    jobs[k].start = {{static_cast<double>(k), 0.0, 0.0}};
  std::size_t computed = 0;
  int calls = 0, last = 1;
  const search::ReplayBatch replay = [&](std::span<const search::ReplayJob> some) {
    if (calls++ == last) throw Killed();
    computed += some.size();
    std::vector<search::ReplayResult> results;
    for (const search::ReplayJob& job : some) results.push_back({job.start, true, 0.5});
    return results;
  };
  {
    UnitJournal journal(folder.path / "journal", kGeneration);
    EXPECT_THROW(journaled<ReplayService>(replay, journal, shape)(jobs), Killed);
  }
  last = -1;
  UnitJournal journal(folder.path / "journal", kGeneration);
  const auto found = journaled<ReplayService>(replay, journal, shape)(jobs);
  EXPECT_EQ(computed, jobs.size());
  for (std::size_t k = 0; k < jobs.size(); ++k) EXPECT_EQ(found[k].end, jobs[k].start);
}

}  // namespace
}  // namespace rtg::jobs

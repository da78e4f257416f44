#include "core/search/simulators.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/math/lanes.hpp"
#include "core/threads/cpu_clock.hpp"

namespace rtg::search {
namespace {

/// As many jobs as `count`, told apart by their action.
template <class Job>
std::vector<Job> numbered(int count) {
  std::vector<Job> jobs;
  for (int k = 0; k < count; ++k) jobs.push_back({Poses{{1.0 * k, 0, 0}}, k});
  return jobs;
}

TEST(BatchesOnThreads, SolvesInJobOrderForAnyNumberOfThreads) {
  const std::vector<reverse::ReverseJob> jobs = numbered<reverse::ReverseJob>(100);
  for (int threads = 1; threads <= 8; ++threads) {
    const SolveBatch solve = solve_on_threads(
        [](std::span<const reverse::ReverseJob> some) {
          std::vector<reverse::ReverseResult> answers;
          for (const reverse::ReverseJob& job : some)
            answers.push_back({reverse::SolveStatus::kInfeasible, 2 * job.action, {job.end}, -1.0});
          return answers;
        },
        threads);
    const std::vector<reverse::ReverseResult> results = solve(jobs);
    ASSERT_EQ(results.size(), jobs.size());
    for (std::size_t k = 0; k < jobs.size(); ++k) {
      ASSERT_EQ(results[k].iterations, 2 * jobs[k].action);
      ASSERT_EQ(results[k].predecessors.at(0), jobs[k].end);
      ASSERT_EQ(results[k].status, reverse::SolveStatus::kInfeasible);
      ASSERT_GE(results[k].cpu_s, 0.0);  // filled in
    }
    EXPECT_TRUE(solve({}).empty());
  }
}

TEST(BatchesOnThreads, ReplaysInJobOrderForAnyNumberOfThreads) {
  const std::vector<ReplayJob> jobs = numbered<ReplayJob>(100);
  for (int threads = 1; threads <= 8; ++threads) {
    const ReplayBatch replay = replay_on_threads(
        [](const ReplayJob& job) {
          return ReplayResult{job.start, job.action % 3 == 0, -1.0};
        },
        threads);
    const std::vector<ReplayResult> results = replay(jobs);
    ASSERT_EQ(results.size(), jobs.size());
    for (std::size_t k = 0; k < jobs.size(); ++k) {
      ASSERT_EQ(results[k].end, jobs[k].start);
      ASSERT_EQ(results[k].ok, jobs[k].action % 3 == 0);
      ASSERT_GE(results[k].cpu_s, 0.0);
    }
    EXPECT_TRUE(replay({}).empty());
  }
}

/// Works for 2 ms of the thread's CPU time.
void work() {
  for (const double begin = threads::thread_cpu_s(); threads::thread_cpu_s() < begin + 0.002;) {
  }
}

// A single thread is the caller's own, whose clock also runs between the jobs.
TEST(BatchesOnThreads, JobsShareTheCpuTimeThatTheyTook) {
  const double begin = threads::thread_cpu_s();
  double solves = 0.0, replays = 0.0;
  const SolveBatch solve = solve_on_threads(
      [](std::span<const reverse::ReverseJob> some) {
        work();
        return std::vector<reverse::ReverseResult>(some.size());
      },
      1);
  const std::vector<reverse::ReverseResult> solved = solve(numbered<reverse::ReverseJob>(100));
  for (const reverse::ReverseResult& result : solved) {
    EXPECT_EQ(result.cpu_s, solved[0].cpu_s);  // they were solved together
    solves += result.cpu_s;
  }
  const ReplayBatch replay = replay_on_threads(
      [](const ReplayJob&) {
        work();
        return ReplayResult{};
      },
      1);
  for (const ReplayResult& result : replay(numbered<ReplayJob>(3))) replays += result.cpu_s;
  EXPECT_GE(solves, 0.00199);
  EXPECT_GE(replays, 0.00599);
  EXPECT_LE(solves + replays, threads::thread_cpu_s() - begin);
}

TEST(BatchesOnThreads, PassesExceptionsOnToTheCaller) {
  const SolveBatch solve = solve_on_threads(
      [](std::span<const reverse::ReverseJob> some) {
        for (const reverse::ReverseJob& job : some)
          if (job.action >= 7) throw std::runtime_error("job " + std::to_string(job.action));
        return std::vector<reverse::ReverseResult>(some.size());
      },
      4);
  try {
    static_cast<void>(solve(numbered<reverse::ReverseJob>(50)));
    FAIL() << "no exception";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "job 7");
  }
  EXPECT_EQ(solve(numbered<reverse::ReverseJob>(7)).size(), 7U);  // and goes on working
}

/// Sizes of the slices that `count` jobs are solved in.
std::vector<std::size_t> slices(std::size_t count, int threads) {
  std::mutex mutex;
  std::vector<std::size_t> sizes;
  const SolveBatch solve = solve_on_threads(
      [&](std::span<const reverse::ReverseJob> jobs) {
        const std::lock_guard lock(mutex);
        sizes.push_back(jobs.size());
        return std::vector<reverse::ReverseResult>(jobs.size());
      },
      threads);
  EXPECT_EQ(solve(std::vector<reverse::ReverseJob>(count)).size(), count);
  return sizes;
}

TEST(BatchesOnThreads, NoThreadWaitsForWorkAndNoSliceLeavesLanesIdle) {
  constexpr std::size_t kLanes = kWidth<Lanes>;
  for (const int threads : {2, 3, 8, 16})
    for (const std::size_t count : {1U, 7U, 48U, 192U, 576U, 3072U}) {
      const std::vector<std::size_t> sizes = slices(count, threads);
      const std::size_t wanted =
          std::min<std::size_t>(static_cast<std::size_t>(threads), count / kLanes);
      EXPECT_GE(sizes.size(), wanted) << count << " jobs, " << threads << " threads";
      if (count >= kLanes) {
        EXPECT_GE(std::ranges::min(sizes), kLanes);
      }
    }
  EXPECT_EQ(slices(48, 1), (std::vector<std::size_t>{48}));
  EXPECT_TRUE(slices(0, 2).empty());
}

}  // namespace
}  // namespace rtg::search

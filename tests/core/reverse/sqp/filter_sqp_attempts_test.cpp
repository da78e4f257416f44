// What attempts (SqpStrategy) do for real problems.

#include <gtest/gtest.h>

#include <vector>

#include "core/reverse/candidate.hpp"
#include "tests/bench/corpus.hpp"
#include "tests/support/one_candidate.hpp"

namespace rtg::reverse {
namespace {

/// The corpus' problems with Gathering in which one object may be dragged.
class FilterSqpAttempts : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    jobs_.clear();
    const bench::Corpus corpus = bench::read_corpus(RTG_CORPUS);
    task_ = corpus.tasks.at("gathering");
    for (const bench::Problem& one : corpus.problems)
      if (one.task == "gathering" && one.difficulty == bench::Difficulty::kSingle)
        jobs_.push_back(one.job);
    ASSERT_GT(jobs_.size(), 100u);
  }

  static SqpResult solve(const ReverseJob& job, const ReverseConfig& config) {
    const PhysicsConfig physics;
    return testing::solved(Candidate(task_.scene, physics, task_.push, config, job).problem());
  }

  static inline tasks::Task task_;
  static inline std::vector<ReverseJob> jobs_;
};

// No solution ends nearer to the final state than the force on the touched object compresses the
// spring there.
TEST_F(FilterSqpAttempts, OfSolutionsThatMissTheFinalStateTheFirstIsKept) {
  ReverseConfig strict;
  strict.terminal_tolerance = 1e-4;
  int kept = 0;
  for (const ReverseJob& job : jobs_) {
    const SqpResult hit = solve(job, {}), missed = solve(job, strict);
    if (hit.status != SolveStatus::kConverged || hit.attempts > 1 || missed.attempts != 2 ||
        missed.status == SolveStatus::kConverged)  // the second attempt may find the end after all
      continue;
    EXPECT_EQ(missed.status, SolveStatus::kInfeasible);
    EXPECT_GT(missed.iterations, hit.iterations);
    EXPECT_EQ(missed.x.p[0], hit.x.p[0]);
    EXPECT_EQ(missed.stationarity, hit.stationarity);
    ++kept;
  }
  EXPECT_GE(kept, 5);
}

}  // namespace
}  // namespace rtg::reverse

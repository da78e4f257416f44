// What attempts and softening (SqpStrategy) do for real problems.

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

  struct Solution {
    SqpResult result;
    double objective;
  };
  static Solution solve(const ReverseJob& job, const ReverseConfig& config) {
    const PhysicsConfig physics;
    const Candidate candidate(task_.scene, physics, task_.push, config, job);
    SqpResult result = testing::solved(candidate.problem());
    const double found = objective(candidate.problem(), result.x);
    return {std::move(result), found};
  }

  static inline tasks::Task task_;
  static inline std::vector<ReverseJob> jobs_;
};

// Without it the object slips away from the robot after the last sub-steps. Which problems those
// are depends on rounding; that they are many more than the contrary does not.
TEST_F(FilterSqpAttempts, SofteningFindsThatAnObjectCanBeDraggedAlong) {
  ReverseConfig soft, still;
  still.softenings = 0;
  int better = 0, worse = 0;
  for (const ReverseJob& job : jobs_) {
    const Solution with = solve(job, soft), without = solve(job, still);
    if (with.result.status != SolveStatus::kConverged ||
        without.result.status != SolveStatus::kConverged)
      continue;
    better += with.objective < without.objective - 0.1;
    worse += with.objective > without.objective + 0.1;
  }
  RecordProperty("better", better);
  RecordProperty("worse", worse);
  EXPECT_GE(better, 5);
  EXPECT_LT(3 * worse, better);
}

// No solution ends nearer to the final state than the force on the touched object compresses the
// spring there.
TEST_F(FilterSqpAttempts, OfSolutionsThatMissTheFinalStateTheFirstIsKept) {
  ReverseConfig strict;
  strict.terminal_tolerance = 1e-4;
  int kept = 0;
  for (const ReverseJob& job : jobs_) {
    const SqpResult hit = solve(job, {}).result, missed = solve(job, strict).result;
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

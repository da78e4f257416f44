// Many candidates at once.

#include <gtest/gtest.h>

#include "core/reverse/candidate.hpp"
#include "tests/support/one_candidate.hpp"
#include "tests/support/touching_scene.hpp"

namespace rtg::reverse {
namespace {

using testing::solved;
using testing::TouchingScene;

/// Problems of the same numbers of bodies that end in different ways and after different numbers
/// of iterations: the touching scene pushed in 48 directions.
struct Batch {
  TouchingScene scene;
  ReverseConfig config;
  std::vector<ReverseProblem> problems;
  std::vector<const ReverseProblem*> all;

  Batch() {
    config.max_iterations = 60;
    for (int action = 0; action < 48; ++action) {
      problems.push_back(scene.problem(config));
      problems.back().direction = direction(action, scene.task.push);
    }
    for (const ReverseProblem& one : problems) all.push_back(&one);
  }
  std::vector<SqpResult> solve(std::span<const ReverseProblem* const> some) const {
    return FilterSqp<Lanes>(problems[0], std::make_unique<Riccati<Lanes>>(3, 10)).solve(some);
  }
};

void expect_same_bits(const SqpResult& a, const SqpResult& b) {
  EXPECT_EQ(a.status, b.status);
  EXPECT_EQ(a.iterations, b.iterations);
  EXPECT_EQ(a.stationarity, b.stationarity);
  for (std::size_t k = 0; k < a.x.p.size(); ++k) {
    EXPECT_EQ(a.x.p[k], b.x.p[k]);
    EXPECT_EQ(a.x.forces[k], b.x.forces[k]);
    EXPECT_EQ(a.x.controls[k], b.x.controls[k]);
    EXPECT_EQ(a.x.multipliers[k], b.x.multipliers[k]);
  }
}

TEST(FilterSqpLanes, ACandidatesBitsDoNotDependOnThoseBesideIt) {
  const Batch batch;
  const std::vector<SqpResult> together = batch.solve(batch.all);
  std::vector<const ReverseProblem*> reversed(batch.all.rbegin(), batch.all.rend());
  const std::vector<SqpResult> backwards = batch.solve(reversed);
  int long_ones = 0;
  for (std::size_t k = 0; k < batch.all.size(); ++k) {
    expect_same_bits(together[k], backwards[batch.all.size() - 1 - k]);
    long_ones += together[k].iterations > 10;
    if (k % 7 == 0) expect_same_bits(together[k], batch.solve({&batch.all[k], 1}).front());
  }
  EXPECT_GT(long_ones, 5);
}

// Rounding may lead long solves elsewhere.
TEST(FilterSqpLanes, LanesFindTheSolutionsOfDouble) {
  const Batch batch;
  const std::vector<SqpResult> lanes = batch.solve(batch.all);
  int compared = 0;
  for (std::size_t k = 0; k < batch.all.size(); ++k) {
    const SqpResult one = solved(batch.problems[k]);
    if (one.status != SolveStatus::kConverged || one.iterations > 25) continue;
    ++compared;
    EXPECT_EQ(lanes[k].iterations, one.iterations);
    EXPECT_LT((one.x.p[0] - lanes[k].x.p[0]).norm(), 1e-9);
  }
  EXPECT_GE(compared, 15);
}

TEST(FilterSqpLanes, LanesAreKeptBusy) {
  const Batch batch;
  FilterSqp<Lanes> sqp(batch.problems[0], std::make_unique<Riccati<Lanes>>(3, 10));
  static_cast<void>(sqp.solve(batch.all));
  EXPECT_GT(sqp.occupancy(), 0.6);
  EXPECT_LE(sqp.occupancy(), 1.0);
}

/// Lines 626, 731, 781, 861 and 993 of tests/bench/corpus/problems.txt, on which the first attempt
/// gets stuck; on another processor, rounding may save one or the other.
const std::vector<ReverseJob> kStuck{{{{2.42285872, 2.21452594, -0.00326369028},
                                       {-1.43198597, 0.348498374, -1.59337211},
                                       {2.75083327, 0.804926038, -0.19779171},
                                       {2.34919047, -2.14103651, 1.74777508}},
                                      29},
                                     {{{2.50206089, -5.39191341, -0.000829908473},
                                       {-1.4289068, 0.349773824, -1.59337211},
                                       {1.40988863, 0.165141121, -0.291031063},
                                       {1.8566041, -2.34097528, 1.59911442}},
                                      40},
                                     {{{2.76820993, 1.91269207, 0},
                                       {-0.872250795, -1.17329562, -2.83504224},
                                       {1.59056318, 0.965075076, -1.38627231},
                                       {1.5975163, -0.290908247, -1.38627231}},
                                      26},
                                     {{{-2.32644224, -0.0828956515, 0},
                                       {-1.17807949, -0.989711285, 2.24033237},
                                       {1.27814567, 0.430177331, 1.30293584},
                                       {1.11396551, -0.802722454, -1.83865678}},
                                      30},
                                     {{{1.58459759, -1.164886, 0},
                                       {-1.38802171, 0.38005355, -2.15605259},
                                       {-0.037856292, 1.24347663, 1.35052502},
                                       {0.414260954, -0.205891907, 2.10924625}},
                                      9}};

TEST(FilterSqpLanes, FurtherAttemptsGetOutWhereTheFirstIsStuckWithinTheSharedLimit) {
  const tasks::Task task = testing::gathering();
  const PhysicsConfig physics;
  int freed = 0;
  for (const ReverseJob& job : kStuck) {
    ReverseConfig config;
    const Candidate candidate(task.scene, physics, task.push, config, job);
    const Candidate* one = &candidate;
    const SqpResult whole = solve_together({&one, 1}).front();
    if (whole.attempts == 1 || whole.status != SolveStatus::kConverged) continue;
    ++freed;
    config.max_iterations = whole.iterations - 1;
    const SqpResult cut = solve_together({&one, 1}).front();
    EXPECT_EQ(cut.status, SolveStatus::kIterationLimit);
    EXPECT_EQ(cut.iterations, config.max_iterations);
    EXPECT_EQ(cut.attempts, whole.attempts);
  }
  EXPECT_GE(freed, 2);
}

}  // namespace
}  // namespace rtg::reverse

// Many candidates at once.

#include <gtest/gtest.h>

#include "core/reverse/candidate.hpp"
#include "tests/support/one_candidate.hpp"
#include "tests/support/touching_scene.hpp"

namespace rtg {
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
  EXPECT_GE(compared, 24);
}

TEST(FilterSqpLanes, LanesAreKeptBusy) {
  const Batch batch;
  FilterSqp<Lanes> sqp(batch.problems[0], std::make_unique<Riccati<Lanes>>(3, 10));
  static_cast<void>(sqp.solve(batch.all));
  EXPECT_GT(sqp.occupancy(), 0.6);
  EXPECT_LE(sqp.occupancy(), 1.0);
}

/// Lines 747, 769, 839, 844 and 1014 of tests/bench/corpus/problems.txt, on which the first attempt
/// gets stuck; on another processor, rounding may save one or the other.
const std::vector<ReverseJob> kStuck{{{{2.76820993, 1.91269207, 0},
                                       {-0.872250795, -1.17329562, -2.83504224},
                                       {1.59056318, 0.965075076, -1.38627231},
                                       {1.5975163, -0.290908247, -1.38627231}},
                                      30},
                                     {{{2.76820993, 1.91269207, 0},
                                       {-0.872250795, -1.17329562, -2.83504224},
                                       {1.59056318, 0.965075076, -1.38627231},
                                       {1.5975163, -0.290908247, -1.38627231}},
                                      27},
                                     {{{2.76820993, 1.91269207, 0},
                                       {-0.872250795, -1.17329562, -2.83504224},
                                       {1.59056318, 0.965075076, -1.38627231},
                                       {1.5975163, -0.290908247, -1.38627231}},
                                      31},
                                     {{{2.29444551, -2.28759646, 0},
                                       {-1.4289068, 0.349773824, -1.59337211},
                                       {1.40985918, 0.168148413, -0.288589776},
                                       {1.27493978, -1.14126623, 1.28220654}},
                                      11},
                                     {{{1.58459759, -1.164886, 0},
                                       {-1.38802171, 0.38005355, -2.15605259},
                                       {-0.037856292, 1.24347663, 1.35052502},
                                       {0.414260954, -0.205891907, 2.10924625}},
                                      15}};

TEST(FilterSqpLanes, FurtherAttemptsGetOutWhereTheFirstIsStuckWithinTheSharedLimit) {
  const Task task = testing::gathering();
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
}  // namespace rtg

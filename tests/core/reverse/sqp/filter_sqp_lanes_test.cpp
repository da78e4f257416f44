// Many candidates at once.

#include <gtest/gtest.h>

#include <vector>

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
  template <class Kkt = Riccati<Lanes>>
  std::vector<SqpResult> solve(std::span<const ReverseProblem* const> some) const {
    return FilterSqp<Lanes>(problems[0], std::make_unique<Kkt>(3, 10)).solve(some);
  }
};

/// Reports every system as singular.
class NeverRegular final : public StageSolver<Lanes> {
 public:
  NeverRegular(int, int) {}
  Mask<Lanes> solve(const StageSystem<Lanes>&, StageStep<Lanes>&) override {
    return Mask<Lanes>(false);
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

TEST(FilterSqpLanes, ARestoredCandidatesBitsDoNotDependOnThoseBesideIt) {
  const Batch batch;
  const auto some = std::span(batch.all).first(12);
  const std::vector<SqpResult> together = batch.solve<NeverRegular>(some);
  int restored = 0;
  for (std::size_t k = 0; k < some.size(); ++k) {
    restored += together[k].iterations > 20;  // ten pivoted, ten more only after a restoration
    if (k % 4 == 0) expect_same_bits(together[k], batch.solve<NeverRegular>({&some[k], 1}).front());
  }
  EXPECT_GT(restored, 2);
}

// Rounding may lead long solves elsewhere.
TEST(FilterSqpLanes, LanesFindTheSolutionsOfDouble) {
  Batch batch;
  batch.config.stationarity_tol = batch.config.feasibility_tol = 1e-9;
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

}  // namespace
}  // namespace rtg::reverse

// Lanes whose candidates have little in common.

#include <gtest/gtest.h>

#include <numbers>

#include "core/energy/open_gaps.hpp"
#include "tests/support/one_candidate.hpp"
#include "tests/support/touching_scene.hpp"

namespace rtg::reverse {
namespace {

using testing::TouchingScene;

/// A polygon of 3 to 8 corners, a disc, a polygon with round corners.
Shape shape_number(int number) {
  if (number < 9) return regular_polygon(number, 0.6);
  return Shape(number == 9 ? disc(0.55) : Part{regular_polygon(5, 0.4), 0.15});
}

/// The touching scene with an object of that shape in front of the robot.
struct OtherShapes : TouchingScene {
  ReverseProblem problem;

  OtherShapes(int number, const ReverseConfig& config) : problem{TouchingScene::problem(config)} {
    scene.bodies[1].shape = shape_number(number);
    scene.bodies[2].shape = number % 2 == 0 ? regular_polygon(3, 0.7) : box(1.0, 0.8);
    energy = energy::StepEnergy(scene, physics, task.push);
    problem.end = with_open_gaps(
        energy, energy::stacked({{0, 0, 0}, {1.38, 0.1, 0.2 + 0.1 * number}, {2.7, 0.3, 0.6}}));
  }
  OtherShapes(const OtherShapes&) = delete;
};

std::vector<SqpResult> solve(std::span<const ReverseProblem* const> problems) {
  return FilterSqp<Lanes>(*problems[0], std::make_unique<Riccati<Lanes>>(3, 10)).solve(problems);
}

TEST(FilterSqpMixed, CandidatesOfOtherShapesHaveTheBitsThatTheyHaveAlone) {
  const ReverseConfig config;
  std::vector<std::unique_ptr<OtherShapes>> scenes;
  std::vector<const ReverseProblem*> problems;
  for (int k = 0; k < 16; ++k) {
    scenes.push_back(std::make_unique<OtherShapes>(3 + k % 8, config));
    problems.push_back(&scenes.back()->problem);
  }
  const std::vector<SqpResult> together = solve(problems);
  int converged = 0, long_ones = 0;
  for (std::size_t k = 0; k < problems.size(); ++k) {
    const SqpResult alone = solve({&problems[k], 1}).front();
    EXPECT_EQ(together[k].status, alone.status) << k;
    EXPECT_EQ(together[k].iterations, alone.iterations) << k;
    EXPECT_EQ(together[k].x.p, alone.x.p) << k;
    EXPECT_EQ(together[k].x.forces, alone.x.forces) << k;
    converged += alone.status == SolveStatus::kConverged;
    long_ones += alone.iterations > 10;
  }
  EXPECT_GE(converged, 6);
  EXPECT_GE(long_ones, 6);
}

// Crossing bars have open gaps throughout.
TEST(FilterSqpMixed, OverlapAndNonsenseBesideAGoodCandidateLeaveItAlone) {
  const ReverseConfig config;
  TouchingScene touching;
  TouchingScene bars;
  bars.scene.bodies[1].shape = box(4.0, 0.2);
  bars.scene.bodies[2].shape = box(0.2, 4.0);
  bars.energy = energy::StepEnergy(bars.scene, bars.physics, bars.task.push);
  const ReverseProblem good = touching.problem(config);
  ReverseProblem crossed = bars.problem(config), overlapping = good;
  crossed.end = energy::stacked({{-9, 0, 0}, {0, 0, 0}, {0, 0, 0}});
  overlapping.end = energy::stacked({{0, 0, 0}, {1, 0, 0}, {5, 0, 0}});
  ASSERT_GT(least_gap(bars.energy, crossed.end), 0.0);
  const std::vector<const ReverseProblem*> all{&crossed, &good, &overlapping, &good};
  const std::vector<SqpResult> results = solve(all);
  const SqpResult alone = solve({&all[1], 1}).front();
  EXPECT_EQ(results[0].status, SolveStatus::kInfeasible);
  EXPECT_EQ(results[2].status, SolveStatus::kInfeasible);
  ASSERT_EQ(alone.status, SolveStatus::kConverged);
  for (const std::size_t k : {1, 3}) {
    EXPECT_EQ(results[k].status, SolveStatus::kConverged);
    EXPECT_EQ(results[k].x.p, alone.x.p);
  }

  std::vector<Iterate> starts(4, static_iterate(good));
  starts[0] = static_iterate(crossed);
  starts[2].controls[3][1] = NAN;
  const std::vector<const ReverseProblem*> given{&crossed, &good, &good, &good};
  const std::vector<SqpResult> from =
      FilterSqp<Lanes>(good, std::make_unique<Riccati<Lanes>>(3, 10)).solve(given, starts);
  EXPECT_EQ(from[0].status, SolveStatus::kNonFinite);
  EXPECT_EQ(from[2].status, SolveStatus::kNonFinite);
  EXPECT_EQ(from[1].x.p, from[3].x.p);
  EXPECT_EQ(from[1].status, from[3].status);
}

TEST(FilterSqpMixed, EveryLaneStopsAtTheIterationLimit) {
  ReverseConfig config;
  const TouchingScene scene;
  const ReverseProblem problem = scene.problem(config);
  const std::vector<const ReverseProblem*> all(11, &problem);
  for (const int limit : {0, 1, 3}) {
    config.max_iterations = limit;
    for (const SqpResult& result : solve(all)) {
      EXPECT_EQ(result.status, SolveStatus::kIterationLimit);
      EXPECT_EQ(result.iterations, limit);
    }
  }
}

}  // namespace
}  // namespace rtg::reverse

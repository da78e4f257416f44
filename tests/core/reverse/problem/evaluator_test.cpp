#include "core/reverse/problem/evaluator.hpp"

#include <gtest/gtest.h>

#include "tests/support/one_candidate.hpp"
#include "tests/support/touching_scene.hpp"

namespace rtg::reverse {
namespace {

using testing::TouchingScene;

/// Returns whether `after` is a legal trial point of `before`, all levels alike but level 1.
bool is_legal(const ReverseProblem& problem, const VectorXd& before, const VectorXd& after) {
  ProblemLanes<double> lanes(problem);
  lanes.load(0, problem);
  Iterate x = static_iterate(problem);
  for (VectorXd& p : x.p) p = before;
  for (VectorXd& lambda : x.forces) lambda = problem.energy.forces(before);
  Trajectory<double> trajectory(lanes.energy, problem.sub_steps);
  trajectory.load(0, problem, x);
  Evaluator<double> evaluator(lanes);
  PerContact<double> gaps = trajectory.forces, trial_gaps = gaps;
  for (std::vector<double>& level : gaps) level.assign(level.size(), 0.0);
  bool legal = true;
  evaluator.evaluate(lanes, trajectory, gaps, gaps, legal);
  EXPECT_TRUE(legal);
  x.p[1] = after;
  trajectory.load(0, problem, x);
  evaluator.evaluate(lanes, trajectory, gaps, trial_gaps, legal);
  return legal;
}

VectorXd boxes_apart(double gap) {
  return energy::stacked({{-5, 0, 0}, {0, 0, 0}, {0.1, 1.2 + gap, 0}});
}

TEST(Evaluator, GapsKeepATenthOfThemselves) {
  const TouchingScene scene;
  const ReverseConfig config;
  const ReverseProblem problem = scene.problem(config);
  EXPECT_TRUE(is_legal(problem, boxes_apart(0.01), boxes_apart(0.0012)));
  EXPECT_FALSE(is_legal(problem, boxes_apart(0.01), boxes_apart(0.0008)));
  EXPECT_FALSE(is_legal(problem, boxes_apart(0.01), boxes_apart(-0.001)));
  EXPECT_TRUE(is_legal(problem, boxes_apart(0.01), boxes_apart(0.5)));
  // Far gaps may shrink at will down to the share of the range.
  EXPECT_TRUE(is_legal(problem, boxes_apart(2.0), boxes_apart(0.016)));
  EXPECT_FALSE(is_legal(problem, boxes_apart(2.0), boxes_apart(0.014)));
}

TEST(Evaluator, BodiesMayNotCrossThoughTheirVerticesAreApart) {
  const Scene bars{{{"robot", "robot", box(2.0, 0.2), 1.0, 0.3, false},
                    {"bar", "bar", box(0.2, 2.0), 1.0, 0.3, false}}};
  const energy::StepEnergy energy(bars, {}, {});
  const ReverseConfig config;
  const ReverseProblem problem{energy, config, energy::stacked({{0, 0, 0}, {0.9, 1.3, 0}}),
                               Vector2d::UnitX(), 2};
  EXPECT_FALSE(is_legal(problem, problem.end, energy::stacked({{0, 0, 0}, {0.5, 0.4, 0}})));
  EXPECT_TRUE(is_legal(problem, problem.end, energy::stacked({{0, 0, 0}, {1.3, 0.4, 0}})));
}

// Nothing moves and nothing pushes, so every sub-step is at rest; what is wrong is that bodies so
// near to each other exert no force.
TEST(Evaluator, AForceThatIsNotThereCountsAlthoughAllIsAtRest) {
  const TouchingScene scene;
  const ReverseConfig config;
  ReverseProblem problem = scene.problem(config);
  problem.end = boxes_apart(0.05);
  Iterate x = static_iterate(problem);
  for (VectorXd& lambda : x.forces) lambda.setZero();
  for (Vector3d& control : x.controls) control.setZero();
  ProblemLanes<double> lanes(problem);
  lanes.load(0, problem);
  Trajectory<double> trajectory(lanes.energy, problem.sub_steps);
  trajectory.load(0, problem, x);
  Evaluator<double> evaluator(lanes);
  PerContact<double> gaps = trajectory.forces;
  for (std::vector<double>& level : gaps) level.assign(level.size(), 0.0);
  bool legal = true;
  const Measures<double> found = evaluator.evaluate(lanes, trajectory, gaps, gaps, legal);
  EXPECT_TRUE(legal);
  EXPECT_GT(found.infeasibility, 100.0 * config.feasibility_tol);
  EXPECT_NEAR(found.infeasibility, violation(problem, x).max(), 1e-12);
  EXPECT_NEAR(found.violation, violation(problem, x).l1(), 1e-12);
}

// A lane that is not legal leaves the others as they are.
TEST(Evaluator, LanesAreEvaluatedAsIfAlone) {
  const TouchingScene scene;
  const ReverseConfig config;
  const ReverseProblem problem = scene.problem(config);
  ProblemLanes<Lanes> lanes(problem);
  Trajectory<Lanes> x(lanes.energy, problem.sub_steps);
  std::vector<Iterate> each;
  Rng rng(1);
  for (int l = 0; l < kWidth<Lanes>; ++l) {
    each.push_back(testing::disturbed(testing::in_contact(problem), 1e-3, rng));
    lanes.load(l, problem);
    if (l == 1) each[1].p[4] = energy::stacked({{0, 0, 0}, {0.5, 0, 0}, {9, 9, 0}});  // overlap
    x.load(l, problem, each.back());
  }
  Evaluator<Lanes> evaluator(lanes);
  PerContact<Lanes> gaps = x.forces;
  for (std::vector<Lanes>& level : gaps) level.assign(level.size(), Lanes(0.0));
  Mask<Lanes> legal(true);
  const Measures<Lanes> found = evaluator.evaluate(lanes, x, gaps, gaps, legal);
  for (int l = 0; l < kWidth<Lanes>; ++l) {
    EXPECT_EQ(lane(legal, l), l != 1);
    if (l == 1) continue;
    const Iterate& one = each[static_cast<std::size_t>(l)];
    EXPECT_NEAR(lane(found.objective, l), objective(problem, one), 1e-12);
    EXPECT_NEAR(lane(found.violation, l), violation(problem, one).l1(), 1e-12);
    EXPECT_NEAR(lane(found.infeasibility, l), violation(problem, one).max(), 1e-12);
  }
}

}  // namespace
}  // namespace rtg::reverse

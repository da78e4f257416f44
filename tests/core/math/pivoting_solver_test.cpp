#include "core/math/pivoting_solver.hpp"

#include <gtest/gtest.h>

#include "core/math/riccati.hpp"
#include "tests/support/random_stages.hpp"
#include "tests/support/stage_lanes.hpp"

namespace rtg {
namespace {

using testing::lane_of;
using testing::randomise;

constexpr int kBodies = 3, kSubSteps = 7, kLast = kWidth<Lanes> - 1;

/// A system in every lane, of which the last one has E_2 with a zero block on its diagonal.
StageSystem<Lanes> system_with_singular_pivot() {
  StageSystem<Lanes> system(kBodies, kSubSteps);
  for (int l = 0; l < kWidth<Lanes>; ++l) randomise(system, l, 1, 3);
  for (int m = 0; m < 9; ++m) set_lane(system.stages[2].E.at(0, 0)(m / 3, m % 3), kLast, 0.0);
  return system;
}

TEST(PivotingSolver, SolvesALaneInWhichThePivotIsSingular) {
  const StageSystem<Lanes> system = system_with_singular_pivot();
  StageStep<Lanes> step(kBodies, kSubSteps);
  ASSERT_FALSE(lane(Riccati<Lanes>(kBodies, kSubSteps).solve(system, step), kLast));
  const StageStep<Lanes> before = step;
  ASSERT_TRUE(PivotingSolver<Lanes>(false).solve(system, kLast, step));

  StageSystem<double> alone(kBodies, kSubSteps);
  randomise(alone, 0, 1, 3);
  alone.stages[2].E.at(0, 0).setZero();
  const Assembled assembled(alone, false);
  for (int l = 0; l < kLast; ++l) {
    const StageStep<double> now = lane_of(step, l), then = lane_of(before, l);
    EXPECT_EQ(assembled.written(now), assembled.written(then)) << l;
  }
  const VectorXd off =
      joined(product(assembled.matrix(), assembled.written(lane_of(step, kLast)))) -
      joined(assembled.right_hand_side());
  EXPECT_LT(off.norm(), 1e-10);
}

TEST(PivotingSolver, ReportsASystemThatIsSingularAsAWhole) {
  StageSystem<double> system(kBodies, kSubSteps);
  randomise(system, 0, 1, 3);
  constexpr int kNone = kBodies - 1;  // a body that appears nowhere
  for (auto& stage : system.stages)
    for (BlockMatrix<double>* A : {&stage.Q, &stage.E, &stage.F, &stage.N})
      for (int i = 0; i < kBodies; ++i) {
        A->at(i, kNone).setZero();
        A->at(kNone, i).setZero();
      }
  StageStep<double> step(kBodies, kSubSteps);
  EXPECT_FALSE(PivotingSolver<double>(false).solve(system, 0, step));
}

}  // namespace
}  // namespace rtg

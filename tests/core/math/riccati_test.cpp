#include "core/math/riccati.hpp"

#include <gtest/gtest.h>

#include "core/math/assembled_solver.hpp"
#include "tests/support/random_stages.hpp"

namespace rtg {
namespace {

using testing::Levels;
using testing::randomise;

constexpr int kSubSteps = 7;
constexpr int kLast = kWidth<Lanes> - 1;

/// Largest difference of lane l of a step from a step in double.
template <class T>
double difference(const StageStep<T>& a, int l, const StageStep<double>& b) {
  double top = 0.0;
  const auto compare = [&](const Vec3<T>& x, const Vec3<double>& y) {
    for (int m = 0; m < 3; ++m) top = std::max(top, std::abs(lane(x[m], l) - y[m]));
  };
  for (std::size_t k = 0; k < a.poses.size(); ++k) {
    for (std::size_t i = 0; i < a.poses[k].size(); ++i) compare(a.poses[k][i], b.poses[k][i]);
    if (k == 0) continue;
    compare(a.controls[k], b.controls[k]);
    for (std::size_t i = 0; i < a.poses[k].size(); ++i)
      compare(a.multipliers[k][i], b.multipliers[k][i]);
  }
  return top;
}

struct Sizes {
  int bodies, reach;
};
// Single bodies, pairs, chains, bands with fill and all pairs.
constexpr Sizes kSizes[] = {{1, 0}, {2, 1}, {3, 1}, {5, 2}, {6, 1}, {6, 5}, {9, 3}};

// The oracle shifts the multipliers' diagonal by 1e-9.
TEST(Riccati, SolvesRandomSystemsAsSuiteSparseDoes) {
  for (const Levels levels : {Levels::kTwo, Levels::kThree})
    for (const auto [bodies, reach] : kSizes)
      for (const int sub_steps : {kSubSteps, 1, 2}) {
        StageSystem<double> system(bodies, sub_steps);
        randomise(system, 0, reach, 1, levels);
        StageStep<double> step(bodies, sub_steps), oracle = step;
        ASSERT_TRUE(Riccati<double>(bodies, sub_steps).solve(system, step));
        ASSERT_TRUE(AssembledSolver(KktMethod::kUmfpack, false).solve(system, oracle));
        EXPECT_LT(difference(step, 0, oracle), 1e-7)
            << bodies << " bodies, reach " << reach << ", " << sub_steps << " sub-steps";
      }
}

TEST(Riccati, EveryMethodSolvesSystemsWithInertia) {
  for (const int sub_steps : {1, 6, 7}) {
    StageSystem<double> system(3, sub_steps);
    randomise(system, 0, 2, 5, Levels::kThree);
    StageStep<double> step(3, sub_steps), other = step;
    ASSERT_TRUE(Riccati<double>(3, sub_steps).solve(system, step));
    for (const KktMethod method : {KktMethod::kBlockElimination, KktMethod::kCyclicReduction,
                                   KktMethod::kUmfpack, KktMethod::kKlu}) {
      ASSERT_TRUE(AssembledSolver(method, false).solve(system, other));
      EXPECT_LT(difference(step, 0, other), 1e-7) << sub_steps;
    }
  }
}

// In lane l bodies are coupled over l places at most: the pattern is that of all lanes together.
TEST(Riccati, EveryLaneIsSolvedAsIfAlone) {
  constexpr int kBodies = 6;
  StageSystem<Lanes> system(kBodies, kSubSteps);
  for (int l = 0; l < kWidth<Lanes>; ++l) randomise(system, l, l % kBodies, 10 + l, Levels::kThree);
  for (auto& stage : system.stages)  // lanes that do not couple a pair
    for (BlockMatrix<Lanes>* A : {&stage.Q, &stage.E, &stage.F, &stage.N})
      for (int i = 0; i < kBodies; ++i)
        for (int j = 0; j < kBodies; ++j)
          for (int l = 0; l < kWidth<Lanes>; ++l)
            if (A->has(i, j) && std::abs(i - j) > l % kBodies)
              for (int m = 0; m < 9; ++m) set_lane(A->at(i, j)(m / 3, m % 3), l, 0.0);
  StageStep<Lanes> step(kBodies, kSubSteps);
  const Mask<Lanes> regular = Riccati<Lanes>(kBodies, kSubSteps).solve(system, step);
  for (int l = 0; l < kWidth<Lanes>; ++l) {
    StageSystem<double> alone(kBodies, kSubSteps);
    randomise(alone, 0, l % kBodies, 10 + l, Levels::kThree);
    StageStep<double> expected(kBodies, kSubSteps);
    ASSERT_TRUE(Riccati<double>(kBodies, kSubSteps).solve(alone, expected));
    ASSERT_TRUE(lane(regular, l));
    EXPECT_LT(difference(step, l, expected), 1e-12) << l;
  }
}

TEST(Riccati, SolvesAgainAfterAnotherSystem) {
  StageSystem<double> first(3, kSubSteps), second(3, kSubSteps);
  randomise(first, 0, 2, 1);
  randomise(second, 0, 1, 2);
  Riccati<double> solver(3, kSubSteps);
  StageStep<double> step(3, kSubSteps), again = step;
  ASSERT_TRUE(solver.solve(second, step));
  ASSERT_TRUE(solver.solve(first, again));
  ASSERT_TRUE(solver.solve(second, again));
  EXPECT_EQ(difference(again, 0, step), 0.0);
}

TEST(Riccati, ReportsSingularAndNonFiniteLanesAlone) {
  StageSystem<Lanes> system(3, kSubSteps);
  for (int l = 0; l < kWidth<Lanes>; ++l) randomise(system, l, 1, 3);
  set_lane(system.stages[4].E.at(1, 0)(0, 0), kLast, NAN);
  for (int m = 0; m < 3; ++m) {  // lane 0: a residual that does not depend on its pose
    set_lane(system.stages[2].E.at(0, 0)(0, m), 0, 0.0);
    set_lane(system.stages[2].E.at(0, 0)(m, 0), 0, 0.0);
  }
  StageStep<Lanes> step(3, kSubSteps);
  const Mask<Lanes> regular = Riccati<Lanes>(3, kSubSteps).solve(system, step);
  EXPECT_FALSE(lane(regular, 0));
  EXPECT_FALSE(lane(regular, kLast));
  for (int l = 1; l < kLast; ++l) EXPECT_TRUE(lane(regular, l));
}

}  // namespace
}  // namespace rtg

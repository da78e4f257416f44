#include "core/reverse/sqp/l1_merit.hpp"

#include <gtest/gtest.h>

namespace rtg::reverse {
namespace {

TEST(Merit, WeightStaysAboveEveryMultiplierSeen) {
  Merit merit;
  merit.raise_weight_above(2.0);
  const double high = merit.weight();
  EXPECT_GT(high, 2.0);
  merit.raise_weight_above(0.5);
  EXPECT_EQ(merit.weight(), high);  // never falls, or the line search could cycle
  merit.raise_weight_above(0.0);
  EXPECT_GT(Merit().weight(), 0.0);
}

TEST(Merit, IsTheObjectiveAndTheWeightedViolation) {
  Merit merit;
  merit.raise_weight_above(2.0);
  EXPECT_DOUBLE_EQ(merit.value(5.0, 0.25), 5.0 + 0.25 * merit.weight());
  EXPECT_EQ(merit.value(5.0, 0.0), 5.0);
}

// Along a Newton step on linear constraints ‖C‖₁ is (1 - α) of what it was.
TEST(Merit, SlopeIsThatOfAStepOnLinearConstraints) {
  Merit merit;
  merit.raise_weight_above(2.0);
  const auto along = [&](double alpha) {
    return merit.value(5.0 - 3.0 * alpha, 0.25 * (1.0 - alpha));
  };
  EXPECT_NEAR(merit.slope(-3.0, 0.25), (along(1e-3) - along(-1e-3)) / 2e-3, 1e-10);
}

// Exactness: the minimiser of J + ν |C| is that of J on C = 0 once ν exceeds the multiplier. Here
// min x s.t. x = 1 has multiplier 1.
TEST(Merit, IsExactOnceTheWeightExceedsTheMultiplier) {
  Merit merit;
  merit.raise_weight_above(1.0);
  const auto at = [&](double x) { return merit.value(x, std::abs(x - 1.0)); };
  for (const double x : {0.0, 0.9, 0.999, 1.001, 2.0}) EXPECT_GT(at(x), at(1.0));
}

}  // namespace
}  // namespace rtg::reverse

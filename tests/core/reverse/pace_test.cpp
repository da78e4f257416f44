#include "core/reverse/pace.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/touching_scene.hpp"

namespace rtg::reverse {
namespace {

/// The pace of a push to the right with these shares of the largest force, found at `pace`.
double sustained(double pace, const std::vector<double>& shares) {
  const testing::TouchingScene scene;
  const ReverseConfig config;
  ReverseProblem problem = scene.problem(config);
  problem.pace = pace;
  Iterate x = static_iterate(problem);
  for (std::size_t k = 0; k < shares.size(); ++k) x.controls[k + 1][0] = std::atanh(shares[k]);
  return sustained_pace(problem, x);
}

// With pace 0.6, the share 0.8 allows 0.75, and 0.3 twice the speed of the action.
TEST(Pace, TheRobotLagsWhereItsForceIsNotEnoughAndCatchesUpWhereItIs) {
  EXPECT_NEAR(sustained(0.6, std::vector<double>(10, 0.8)), 0.75, 1e-9);
  std::vector<double> shares(10, 0.3);
  EXPECT_EQ(sustained(0.6, shares), 1.0);
  shares[8] = shares[9] = 0.8;
  EXPECT_NEAR(sustained(0.6, shares), 0.95, 1e-9) << "lags at the end by twice a quarter";
  std::swap(shares[8], shares[0]);
  EXPECT_NEAR(sustained(0.6, shares), 0.975, 1e-9) << "and by one, having made up for the other";
  EXPECT_EQ(sustained(0.6, std::vector<double>(10, 0.0)), 1.0);
}

}  // namespace
}  // namespace rtg::reverse

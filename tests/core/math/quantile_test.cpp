#include "core/math/quantile.hpp"

#include <gtest/gtest.h>

namespace rtg {
namespace {

TEST(Quantile, IsTheNearestValueInOrder) {
  const std::vector<int> values{5, 1, 4, 2, 3};
  EXPECT_EQ(quantile(values, 0.0), 1.0);
  EXPECT_EQ(quantile(values, 0.5), 3.0);
  EXPECT_EQ(quantile(values, 0.9), 5.0);
  EXPECT_EQ(quantile(values, 1.0), 5.0);
  EXPECT_EQ(quantile(std::vector<double>{0.25, 0.75}, 0.4), 0.25);
}

TEST(Quantile, OfNothingIsZero) { EXPECT_EQ(quantile(std::vector<float>{}, 0.5), 0.0); }

}  // namespace
}  // namespace rtg

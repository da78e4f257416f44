#include "core/math/draws.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>

namespace rtg {
namespace {

TEST(Drawn, AreSoManyDifferentOnes) {
  Rng rng(1);
  for (int count = 0; count <= 5; ++count) {
    const std::vector<int> found = drawn(std::vector{1, 2, 3, 4, 5}, count, rng);
    EXPECT_EQ(found.size(), static_cast<std::size_t>(count));
    EXPECT_EQ(std::set<int>(found.begin(), found.end()).size(), found.size());
  }
}

TEST(Drawn, AreAllWhereThereAreNoMoreAndNoneWhereLessThanNoneAreWanted) {
  Rng rng(1);
  EXPECT_EQ(drawn(std::vector{1, 2}, 9, rng).size(), 2U);
  EXPECT_TRUE(drawn(std::vector<int>{}, 3, rng).empty());
  EXPECT_TRUE(drawn(std::vector{1, 2}, -1, rng).empty());
}

TEST(Drawn, HaveEveryOneInEveryPlaceAlike) {
  Rng rng(2);
  std::map<std::pair<int, int>, int> counts;
  for (int k = 0; k < 6000; ++k) {
    const std::vector<int> found = drawn(std::vector{0, 1, 2}, 2, rng);
    ++counts[{found[0], found[1]}];
  }
  EXPECT_EQ(counts.size(), 6U);
  for (const auto& [pair, count] : counts) EXPECT_NEAR(count, 1000, 120);
}

}  // namespace
}  // namespace rtg

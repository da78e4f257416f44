#include "core/math/rng.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace rtg {
namespace {

TEST(Rng, IsTheMersenneTwisterSeededBySplitmix) {
  std::mt19937_64 engine(0xe220a8397b1dcdaf);  // splitmix64's first number from the state 0
  Rng rng(0);
  for (int k = 0; k < 5; ++k) EXPECT_EQ(rng.word(), engine());
}

TEST(Rng, UniformIsTheWordsUpper53Bits) {
  Rng words(4), reals(4);
  for (int k = 0; k < 100; ++k) {
    const double share = static_cast<double>(words.word() / 2048) / 9007199254740992.0;  // 2⁵³
    EXPECT_DOUBLE_EQ(reals.uniform(-2.0, 6.0), -2.0 + 8.0 * share);
  }
}

TEST(Rng, BelowGivesEveryNumberAboutEquallyOften) {
  Rng rng(5);
  std::array<int, 6> count{};
  for (int k = 0; k < 60000; ++k) ++count.at(static_cast<std::size_t>(rng.below(6)));
  // Standard deviation √(60000 · 1/6 · 5/6) = 91.
  EXPECT_GT(*std::ranges::min_element(count), 10000 - 5 * 91);
  EXPECT_LT(*std::ranges::max_element(count), 10000 + 5 * 91);
}

TEST(Rng, StreamsOfNeighbouringSeedsAndKeysAreUncorrelated) {
  const auto correlation = [](Rng a, Rng b) {
    double sum = 0.0;
    for (int k = 0; k < 10000; ++k) sum += a.uniform(-1.0, 1.0) * b.uniform(-1.0, 1.0);
    return 3.0 * sum / 10000.0;  // each has the variance 1/3
  };
  const double bound = 5.0 / 100.0;  // five standard deviations of the mean of 10000
  EXPECT_NEAR(correlation(Rng(1), Rng(1)), 1.0, bound);
  EXPECT_NEAR(correlation(Rng(1), Rng(2)), 0.0, bound);
  EXPECT_NEAR(correlation(Rng(1, 1), Rng(1, 2)), 0.0, bound);
  EXPECT_NEAR(correlation(Rng(1, 1), Rng(2, 1)), 0.0, bound);
  EXPECT_NEAR(correlation(Rng(1), Rng(1, 0)), 0.0, bound);
}

TEST(Rng, StreamsDependOnTheOrderOfSeedAndKey) { EXPECT_NE(Rng(1, 2).word(), Rng(2, 1).word()); }

}  // namespace
}  // namespace rtg

#include "core/math/hash.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <unordered_set>

namespace rtg {
namespace {

TEST(Hash, NamesSequencesByTheirWordsAndOrder) {
  EXPECT_NE(hashed(hashed(0, 1), 2), hashed(hashed(0, 2), 1));
  EXPECT_NE(hashed(hashed(0, 1), 2), hashed(hashed(0, 1), 3));
  EXPECT_NE(hashed(1, 5), hashed(2, 5));
}

// As of slots of a grid and as of coordinates.
TEST(Hash, TriplesOfSmallNumbersAndOfRoundRealsAllDiffer) {
  std::unordered_set<std::uint64_t> integers, reals;
  for (int x = -20; x < 20; ++x)
    for (int y = -20; y < 20; ++y)
      for (int z = -20; z < 20; ++z) {
        std::uint64_t a = 0, b = 0;
        for (const int word : {x, y, z}) {
          a = hashed(a, static_cast<std::uint64_t>(word));
          b = hashed(b, std::bit_cast<std::uint64_t>(0.25 * word));
        }
        integers.insert(a);
        reals.insert(b);
      }
  EXPECT_EQ(integers.size(), 64000U);
  EXPECT_EQ(reals.size(), 64000U);
}

// A neighbouring word turns about half of the low bits, by which tables pick their buckets.
TEST(Hash, NeighboursDifferInTheLowBits) {
  int turned = 0;
  for (std::uint64_t word = 0; word < 1000; ++word)
    turned += std::popcount((hashed(7, word) ^ hashed(7, word + 1)) & 0xffff);
  EXPECT_NEAR(turned / 1000.0, 8.0, 2.0);
}

// The naive reverse simulator draws by these bits.
TEST(Hash, ValuesStayTheSame) { EXPECT_EQ(hashed(0, 1), 0x9e3779b9e17d05ac); }

}  // namespace
}  // namespace rtg

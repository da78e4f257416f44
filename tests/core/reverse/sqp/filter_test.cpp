#include "core/reverse/sqp/filter.hpp"

#include <gtest/gtest.h>

namespace rtg::reverse {
namespace {

TEST(Filter, EmptyOneAcceptsEverything) { EXPECT_TRUE(Filter().accepts({1e9, 1e9})); }

TEST(Filter, AcceptsWhatIsBetterThanEveryEntryInOneOfTheTwo) {
  Filter filter;
  filter.add({1.0, 10.0});
  filter.add({0.1, 20.0});
  EXPECT_TRUE(filter.accepts({0.5, 15.0}));    // between the two
  EXPECT_TRUE(filter.accepts({0.01, 100.0}));  // most feasible
  EXPECT_TRUE(filter.accepts({5.0, 9.0}));     // best objective
  EXPECT_FALSE(filter.accepts({1.5, 11.0}));   // dominated by the first
  EXPECT_FALSE(filter.accepts({0.2, 20.5}));   // dominated by the second
}

TEST(Filter, AsksForMoreThanAHairsBreadth) {
  Filter filter;
  filter.add({1.0, 10.0});
  EXPECT_FALSE(filter.accepts({1.0, 10.0}));
  EXPECT_FALSE(filter.accepts({1.0 - 1e-7, 10.0 - 1e-7}));
  EXPECT_TRUE(filter.accepts({1.0 - 1e-4, 10.0}));
  EXPECT_TRUE(filter.accepts({1.0, 10.0 - 1e-4}));
}

TEST(Filter, ImprovementIsByTheMarginInOneOfTheTwo) {
  const Filter::Entry now{1.0, 10.0};
  EXPECT_TRUE(Filter::improves({0.9, 99.0}, now));
  EXPECT_TRUE(Filter::improves({99.0, 9.0}, now));
  EXPECT_FALSE(Filter::improves({1.0 - 1e-7, 10.0 - 1e-7}, now));
  EXPECT_FALSE(Filter::improves({1.1, 10.1}, now));
}

}  // namespace
}  // namespace rtg::reverse

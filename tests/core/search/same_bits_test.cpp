// Transitions are the same, bit for bit, on every x86-64 processor, in every build. What changes the
// physics, the solver or the search changes these digests, too: then the new ones stand here.

#include <gtest/gtest.h>

#include "tests/support/art_manip.hpp"
#include "tests/support/digest.hpp"
#include "tests/support/gathering.hpp"
#include "tests/support/generation_run.hpp"

namespace rtg::search {
namespace {

std::uint64_t digest_of(const tasks::Task& task) {
  SearchConfig config;
  config.transitions = 100;
  config.breadth = 4;
  config.depth = 3;
  const auto seams = testing::seams_of(task, Generator::kRrbs, 2);
  return testing::digest(0, testing::run(task, config, 1, seams).stored);
}

TEST(SameBits, OfBoxes) { EXPECT_EQ(digest_of(testing::gathering()), 0U); }

TEST(SameBits, OfJoints) { EXPECT_EQ(digest_of(testing::art_manip()), 0U); }

}  // namespace
}  // namespace rtg::search

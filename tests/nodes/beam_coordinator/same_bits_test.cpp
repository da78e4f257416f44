// Transitions are the same, bit for bit, on every x86-64 processor and in every build. What changes
// the physics, the solver, the search or a task changes these digests, too. The new ones are those
// that ./test.sh bits prints, where all its builds agree; it generates the same.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/generated.hpp"

namespace rtg::beam_coordinator {
namespace {

std::string digest_of(const std::string& task) {
  const std::vector<std::string> small = {"search.transitions=300", "search.breadth=4",
                                          "search.depth=3"};
  const config::Config config =
      config::load_config(std::string(RTG_CONFIG_FOLDER "/") + task + ".yaml", small);
  return testing::generated(config, 1, 2).rows_sha256;
}

TEST(SameBits, OfBoxesGatheredInACircle) {
  EXPECT_EQ(digest_of("gathering"),
            "32016477d05d9e2660abcea52d0ba38ae19f7e82b0d285d56ae724875ba82b22");
}

TEST(SameBits, OfBoxesOfTwoKinds) {
  EXPECT_EQ(digest_of("sorting"),
            "c8f26cbb1fe8e5febc417e80f6b44d35262f861a1530d17accbd43cf4998f226");
}

TEST(SameBits, OfAChainOfJoints) {
  EXPECT_EQ(digest_of("art_manip"),
            "bc33bc6035a55202b818807d5978fa45e52737f2f6d9757c041cafea7766b441");
}

}  // namespace
}  // namespace rtg::beam_coordinator

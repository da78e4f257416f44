#include "nodes/bus/content_hash.hpp"

#include <gtest/gtest.h>

namespace rtg::bus {
namespace {

std::uint64_t hash(std::string_view text) {
  return static_cast<std::uint64_t>(ContentHash().add(text).value());
}

// The first three are published test vectors of FNV-1a; the last is from Python, with its bytes as
// numbers from 0 to 255.
TEST(ContentHash, IsFnv1aOfTheUnsignedBytes) {
  EXPECT_EQ(hash(""), 0xcbf29ce484222325);
  EXPECT_EQ(hash("a"), 0xaf63dc4c8601ec8c);
  EXPECT_EQ(hash("foobar"), 0x85944171f73967e8);
  EXPECT_EQ(hash("ä€"), 0xd1b7d9e1fd63f89e);
}

TEST(ContentHash, OfPartsIsThatOfTheWhole) {
  EXPECT_EQ(static_cast<std::uint64_t>(ContentHash().add("foo").add("bar").value()),
            hash("foobar"));
}

}  // namespace
}  // namespace rtg::bus

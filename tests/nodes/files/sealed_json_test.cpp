#include "nodes/files/sealed_json.hpp"

#include <gtest/gtest.h>

namespace rtg::files {
namespace {

TEST(SealedJson, EndsInTheDigestOfAllBytesBeforeIt) {
  EXPECT_EQ(
      sealed_json(R"({"a":1})"),
      R"({"a":1,"sha256":"f1d44460187c6a19687e363b30496aeaaa02eedebbf4aa456ec0a9ac0a27623c"})");
}

}  // namespace
}  // namespace rtg::files

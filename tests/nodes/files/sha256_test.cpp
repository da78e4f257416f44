#include "nodes/files/sha256.hpp"

#include <gtest/gtest.h>

#include <string_view>

namespace rtg::files {
namespace {

std::span<const std::uint8_t> bytes(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

TEST(Sha256, IsThatOfTheStandardHoweverTheBytesAreDivided) {
  const std::string of_abc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
  EXPECT_EQ(Sha256().add(bytes("abc")).hex(), of_abc);
  Sha256 sum;
  sum.add(bytes("a"));
  EXPECT_NE(sum.hex(), of_abc);
  EXPECT_EQ(sum.add(bytes("")).add(bytes("bc")).hex(), of_abc);
}

}  // namespace
}  // namespace rtg::files

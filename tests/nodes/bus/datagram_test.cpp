#include "nodes/bus/datagram.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>

namespace rtg::bus {
namespace {

std::span<const std::uint8_t> bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

const std::string kHeader("LC02\0\0\0\1", 8);

TEST(Datagram, HasAChannelAndAPayload) {
  const std::string text = kHeader + std::string("RTG_TAIL\0abc", 12);
  const auto found = parse_datagram(bytes_of(text));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->channel, "RTG_TAIL");
  EXPECT_EQ(std::string(found->payload.begin(), found->payload.end()), "abc");
  EXPECT_TRUE(parse_datagram(bytes_of(kHeader + std::string("A\0", 2)))->payload.empty());
}

TEST(Datagram, AnythingElseIsNone) {
  const std::string longest(63, 'c'), nul(1, '\0');
  EXPECT_TRUE(parse_datagram(bytes_of(kHeader + longest + nul)));
  for (const std::string& text :
       {std::string(), std::string("LC02"), kHeader, kHeader + nul, kHeader + "no end",
        kHeader + longest + "c" + nul, kHeader + longest + "c", kHeader + "a b" + nul,
        kHeader + "\x1b[2J" + nul, kHeader + "\xc3\xa9" + nul, "LC03" + kHeader + "A" + nul,
        std::string("lc02\0\0\0\1A\0", 10)})
    EXPECT_FALSE(parse_datagram(bytes_of(text))) << text;
}

// AddressSanitizer would see a read beyond the end.
TEST(Datagram, AnyBytesAreSafe) {
  std::mt19937 rng(1);
  for (int k = 0; k < 100000; ++k) {
    std::vector<std::uint8_t> bytes(rng() % 90);
    for (auto& b : bytes) b = static_cast<std::uint8_t>(rng() % 3 ? rng() : 'A');
    if (k % 2 && bytes.size() >= 4) std::copy_n("LC02", 4, bytes.begin());
    const auto found = parse_datagram(bytes);
    if (!found) continue;
    EXPECT_LE(found->channel.size(), 63U);
    EXPECT_EQ(8 + found->channel.size() + 1 + found->payload.size(), bytes.size());
  }
}

}  // namespace
}  // namespace rtg::bus

#include "nodes/bus/wire.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "core/math/rng.hpp"
#include "tests/nodes/bus/filled_message.hpp"

namespace rtg::bus {
namespace {

using rtg_msgs::node_status_t;
using rtg_msgs::reverse_job_t;
using rtg_msgs::worker_beat_t;

template <class Msg>
class EveryMessage : public ::testing::Test {};

TYPED_TEST_SUITE(EveryMessage, rtg_msgs::EveryMessage<::testing::Types>);

TYPED_TEST(EveryMessage, SurvivesTheRoundTrip) {
  for (const int n : {0, 1, 3, 50}) {
    auto sent = testing::filled<TypeParam>(n);
    const auto bytes = encode(sent);
    TypeParam received{};
    ASSERT_EQ(decode(bytes, received), std::nullopt);
    EXPECT_EQ(encode(received), bytes);
  }
}

TYPED_TEST(EveryMessage, IsRejectedAtEveryOtherLength) {
  auto sent = testing::filled<TypeParam>();
  auto bytes = encode(sent);
  TypeParam received{};
  for (std::size_t n = 0; n < bytes.size(); ++n)
    EXPECT_EQ(decode(std::span(bytes).first(n), received),
              n < 8 ? WireDefect::kWrongType : WireDefect::kMalformed);
  bytes.push_back(0);
  EXPECT_EQ(decode(bytes, received), WireDefect::kMalformed);
}

// Under AddressSanitizer this also proves that no byte beyond the end is read.
TYPED_TEST(EveryMessage, FlippedBytesAreHarmless) {
  auto sent = testing::filled<TypeParam>(5);
  const auto good = encode(sent);
  Rng rng(7);
  int accepted = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    auto bytes = good;
    for (int k = 0; k < 3; ++k)
      bytes[8 + static_cast<std::size_t>(rng.below(static_cast<int>(bytes.size()) - 8))] =
          static_cast<std::uint8_t>(rng.below(2) ? 0xff : rng.below(256));
    TypeParam received{};
    accepted += !decode(bytes, received).has_value();
  }
  EXPECT_GT(accepted, 0);
}

/// A worker_beat_t with its count n_held overwritten.
std::vector<std::uint8_t> beat_with_count(std::uint32_t n) {
  auto msg = testing::filled<worker_beat_t>();
  auto bytes = encode(msg);
  constexpr std::size_t offset = 8 + 16 + 24;  // fingerprint, header, the fields before it
  for (std::size_t i = 0; i < 4; ++i)
    bytes[offset + i] = static_cast<std::uint8_t>(n >> (24 - 8 * i));
  return bytes;
}

TEST(Wire, HostileCountsAreRejectedBeforeAnythingIsAllocated) {
  worker_beat_t received{};
  ASSERT_EQ(decode(beat_with_count(3), received), std::nullopt);
  for (const std::uint32_t n : {0u, 2u, 4u, 0x7fffffffu, 0x20000000u, 0x80000000u, 0xffffffffu}) {
    EXPECT_EQ(decode(beat_with_count(n), received), WireDefect::kMalformed) << n;
    EXPECT_EQ(received.held.size(), 3u);
  }
}

TEST(Wire, AnUnterminatedTextIsRejected) {
  auto msg = testing::filled<node_status_t>(0);
  auto bytes = encode(msg);
  constexpr std::size_t name = 8 + 16 + 4;  // fingerprint, header, length
  bytes[name + msg.node.size()] = 'x';
  node_status_t received{};
  EXPECT_EQ(decode(bytes, received), WireDefect::kMalformed);
}

// LCM would encode it as a shorter text, with bytes of no field behind.
TEST(Wire, ATextWithANulInsideIsRejected) {
  auto msg = testing::filled<node_status_t>(0);
  auto bytes = encode(msg);
  constexpr std::size_t name = 8 + 16 + 4;  // fingerprint, header, length
  bytes[name + 1] = 0;
  node_status_t received{};
  EXPECT_EQ(decode(bytes, received), WireDefect::kMalformed);
}

TEST(Wire, AnotherTypeIsRejected) {
  auto msg = testing::filled<worker_beat_t>();
  reverse_job_t received{};
  EXPECT_EQ(decode(encode(msg), received), WireDefect::kWrongType);
}

TEST(Wire, NumbersThatAreNotFiniteAreRejected) {
  using Limits = std::numeric_limits<double>;
  for (const double x : {Limits::quiet_NaN(), Limits::infinity()}) {
    auto msg = testing::filled<reverse_job_t>();
    msg.end[1] = x;
    reverse_job_t received{};
    EXPECT_EQ(decode(encode(msg), received), WireDefect::kNotFinite);
  }
}

TEST(Wire, OurOwnMistakesThrow) {
  auto wrong_count = testing::filled<reverse_job_t>();
  wrong_count.n = 4;
  EXPECT_THROW(encode(wrong_count), std::logic_error);
  auto too_long = testing::filled<reverse_job_t>(6000);
  EXPECT_THROW(encode(too_long), std::logic_error);
}

}  // namespace
}  // namespace rtg::bus

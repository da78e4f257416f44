#include "nodes/bus/wire.hpp"

#include <algorithm>

namespace rtg::bus {
namespace {

std::uint64_t big_endian(std::span<const std::uint8_t> bytes) {
  std::uint64_t word = 0;
  for (const std::uint8_t b : bytes) word = word << 8 | b;
  return word;
}

}  // namespace

std::string_view counter_name(WireDefect defect) {
  constexpr std::string_view names[] = {"bus.too_long", "bus.wrong_type", "bus.malformed",
                                        "bus.not_finite"};
  return names[static_cast<int>(defect)];
}

namespace wire {

std::int32_t LayoutCheck::length() {
  if (!ok_ || rest_.size() < 4) return ok_ = false, 0;
  const std::uint64_t n = big_endian(rest_.first(4));
  rest_ = rest_.subspan(4);
  ok_ = n <= kMaxMessageBytes;
  return ok_ ? static_cast<std::int32_t>(n) : 0;
}

void LayoutCheck::skip(std::int32_t n, std::size_t size) {
  const std::size_t bytes = static_cast<std::size_t>(n) * size;
  ok_ = ok_ && bytes <= rest_.size();
  if (ok_) rest_ = rest_.subspan(bytes);
}

void LayoutCheck::skip_text() {
  const auto n = static_cast<std::size_t>(length());
  ok_ = ok_ && n >= 1 && n <= rest_.size() &&
        std::ranges::find(rest_.first(n), 0) == rest_.begin() + static_cast<std::ptrdiff_t>(n) - 1;
  if (ok_) rest_ = rest_.subspan(n);
}

std::int64_t fingerprint_of(std::span<const std::uint8_t> bytes) {
  return bytes.size() < 8 ? 0 : static_cast<std::int64_t>(big_endian(bytes.first(8)));
}

}  // namespace wire

std::int64_t run_of(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t at = 8 + sizeof(rtg_msgs::header_t::protocol);
  return bytes.size() < at + 8 ? 0 : static_cast<std::int64_t>(big_endian(bytes.subspan(at, 8)));
}

}  // namespace rtg::bus

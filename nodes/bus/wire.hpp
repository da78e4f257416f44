#pragma once

#include <cassert>
#include <cmath>
#include <cstdint>
#include <optional>
#include <rtg_msgs/wire_fields.hpp>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace rtg::bus {

/// Maximum size of an encoded message without LCM's packet header [bytes]. LCM would split messages
/// beyond 65,499 bytes, and its reassembly loses and corrupts messages.
inline constexpr std::size_t kMaxMessageBytes = 60000;

/// Reasons to reject received bytes.
enum class WireDefect { kTooLong, kWrongType, kMalformed, kNotFinite };

/// Returns the name of the counter of `defect`.
std::string_view counter_name(WireDefect defect);

namespace wire {

/// Visitor that checks the layout of an encoded message without allocating memory. The generated
/// decoder trusts every array length that it reads. A forged message of 31 bytes could make it
/// allocate gigabytes.
class LayoutCheck {
 public:
  explicit LayoutCheck(std::span<const std::uint8_t> bytes) : rest_(bytes) {}

  template <class T>
  void scalar(const char*, T&) {
    skip(1, sizeof(T));
  }
  void count(const char*, std::int32_t& n) { n = length(); }
  template <class T>
  void array(const char*, std::vector<T>&, std::int32_t n) {
    skip(n, sizeof(T));
  }
  void text(const char*, std::string&) { skip_text(); }
  void texts(const char*, std::vector<std::string>&, std::int32_t n) {
    for (std::int32_t i = 0; i < n && ok_; ++i) skip_text();
  }

  /// Returns whether the visited fields fill the bytes exactly.
  bool complete() const { return ok_ && rest_.empty(); }

 private:
  std::int32_t length();  // reads a big-endian count, 0 ... kMaxMessageBytes
  void skip(std::int32_t n, std::size_t size);
  void skip_text();  // skips the length, which counts the only NUL, the last byte, and the bytes

  std::span<const std::uint8_t> rest_;
  bool ok_ = true;
};

/// Visitor that checks whether all numbers of a decoded message are finite.
struct FiniteCheck {
  bool ok = true;

  template <class T>
  void scalar(const char*, T& x) {
    if constexpr (std::is_floating_point_v<T>) ok = ok && std::isfinite(x);
  }
  void count(const char*, std::int32_t&) {}
  template <class T>
  void array(const char*, std::vector<T>& values, std::int32_t) {
    for (T& x : values) scalar("", x);
  }
  void text(const char*, std::string&) {}
  void texts(const char*, std::vector<std::string>&, std::int32_t) {}
};

/// Visitor that checks whether the arrays of an outgoing message have the announced lengths. The
/// generated encoder reads past the end of an array that is too short.
struct CountCheck {
  bool ok = true;

  template <class T>
  void scalar(const char*, T&) {}
  void count(const char*, std::int32_t& n) { ok = ok && n >= 0; }
  template <class T>
  void array(const char*, std::vector<T>& values, std::int32_t n) {
    ok = ok && values.size() == static_cast<std::size_t>(n);
  }
  void text(const char*, std::string&) {}
  void texts(const char*, std::vector<std::string>& values, std::int32_t n) {
    array("", values, n);
  }
};

/// Returns the fingerprint of an encoded message; 0 if `bytes` are too short.
std::int64_t fingerprint_of(std::span<const std::uint8_t> bytes);

}  // namespace wire

/// Returns `header.run` of an encoded message, which is no more than its sender's word; 0 if
/// `bytes` are too short.
std::int64_t run_of(std::span<const std::uint8_t> bytes);

/// Returns the encoded message. Throws std::logic_error if an array does not have the announced
/// length or the message exceeds kMaxMessageBytes.
template <class Msg>
std::vector<std::uint8_t> encode(Msg& msg) {
  wire::CountCheck consistent;
  fields(consistent, msg);
  if (!consistent.ok)
    throw std::logic_error(std::string(Msg::getTypeName()) + ": counts do not match the arrays");
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(msg.getEncodedSize()));
  if (bytes.size() > kMaxMessageBytes)
    throw std::logic_error(std::string(Msg::getTypeName()) + ": longer than one datagram");
  msg.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

/// Decodes `bytes` into `msg`. Returns the defect if `bytes` is no valid message of this type, else
/// nothing. Safe for arbitrary bytes.
template <class Msg>
[[nodiscard]] std::optional<WireDefect> decode(std::span<const std::uint8_t> bytes, Msg& msg) {
  if (bytes.size() > kMaxMessageBytes) return WireDefect::kTooLong;
  if (wire::fingerprint_of(bytes) != Msg::getHash()) return WireDefect::kWrongType;
  wire::LayoutCheck layout(bytes.subspan(8));
  Msg counts{};
  fields(layout, counts);
  const int size = static_cast<int>(bytes.size());
  if (!layout.complete() || msg.decode(bytes.data(), 0, size) != size)
    return WireDefect::kMalformed;
  wire::FiniteCheck finite;
  fields(finite, msg);
  if (!finite.ok) return WireDefect::kNotFinite;
  return std::nullopt;
}

}  // namespace rtg::bus

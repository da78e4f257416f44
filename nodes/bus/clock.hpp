#pragma once

#include <chrono>
#include <cstdint>
#include <random>

#include "nodes/bus/seconds.hpp"

namespace rtg::bus {

/// Returns the time of the monotonic clock that all timeouts use.
inline Seconds monotonic_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Timer that is due() every `interval` seconds, the first time at once.
class Ticker {
 public:
  explicit Ticker(Seconds interval) : interval_(interval) {}

  bool due(Seconds now) {
    if (now < next_) return false;
    next_ = now + interval_;
    return true;
  }

  /// Makes it due() at once.
  void hurry() { next_ = 0.0; }

 private:
  Seconds interval_;
  Seconds next_ = 0.0;
};

/// Returns a random 64-bit number, for example as the identity of a process start.
inline std::int64_t random_identity() {
  std::random_device device;
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(device()) << 32 | device());
}

}  // namespace rtg::bus

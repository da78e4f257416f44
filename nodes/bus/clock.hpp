#pragma once

#include <chrono>
#include <cstdint>
#include <random>

#include "nodes/bus/seconds.hpp"

namespace rtg::bus {

/// The clock of all timeouts; never set back.
inline Seconds monotonic_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Says when something that happens every `interval` seconds is due again, the first time at once.
class Ticker {
 public:
  explicit Ticker(Seconds interval) : interval_(interval) {}

  bool due(Seconds now) {
    if (now < next_) return false;
    next_ = now + interval_;
    return true;
  }

 private:
  Seconds interval_;
  Seconds next_ = 0.0;
};

/// A name that no other process start has.
inline std::int64_t random_identity() {
  std::random_device device;
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(device()) << 32 | device());
}

}  // namespace rtg::bus

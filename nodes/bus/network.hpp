#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "nodes/bus/bus_url.hpp"
#include "nodes/bus/counters.hpp"
#include "nodes/bus/datagram.hpp"

namespace rtg::bus {

/// Carries datagrams of LCM's format: LCM sends them, UdpReceiver receives them. With "memq://"
/// they stay in this object.
class Network {
 public:
  virtual ~Network() = default;

  /// Returns whether the datagram was sent. May be called from any thread.
  virtual bool send(const std::string& channel, std::span<const std::uint8_t> payload) = 0;

  /// What became of a datagram: handled, or of no interest, or not to be trusted.
  enum class Verdict { kHandled, kIgnored, kRefused };
  using Handler = std::function<Verdict(const Datagram&)>;

  /// Waits up to `timeout` for a datagram that gets handled. Then passes on all that have arrived,
  /// at most 1000, and returns how many of them were handled. A signal ends the wait
  /// ("bus.interrupted"). Counts bytes that are no datagram of LCM as "bus.malformed"; they are
  /// refused, too. Waits after what was refused for 2 ms before it looks again, so that a flood of
  /// it does not wake the process with every datagram. Lets the exceptions of `handle` through; the
  /// next call goes on with the next datagram.
  int spin(std::chrono::milliseconds timeout, Counters& counters, const Handler& handle);

  /// Returns a warning for the user; empty if there is none.
  virtual std::string warning() const { return ""; }

 protected:
  /// Returns the bytes of the next datagram, or nothing if none arrives until `timeout` or a
  /// signal. They are valid until the next call, and empty if the datagram is none for us.
  virtual std::optional<std::span<const std::uint8_t>> next(std::chrono::milliseconds timeout,
                                                            Counters& counters) = 0;
};

/// Opens the network at `url`. Throws std::invalid_argument for an illegal URL, std::runtime_error
/// if it cannot be opened or does not bring back what is sent.
std::unique_ptr<Network> open_network(const std::string& url);

}  // namespace rtg::bus

#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>

#include "nodes/bus/bus_url.hpp"
#include "nodes/bus/counters.hpp"
#include "nodes/files/descriptor.hpp"

struct msghdr;

namespace rtg::bus {

/// What helps where multicast does not work.
inline constexpr const char* kMulticastRemedy =
    "To mend it: sudo ip link set lo multicast on && sudo ip route add 224.0.0.0/4 dev lo";

/// The receiving end of a multicast group. It hears the processes of this machine and the peers
/// that the URL names; datagrams of all others are dropped and counted ("bus.stranger"), as are
/// empty ones ("bus.malformed") and those for which there was no room ("bus.overflowed").
///
/// LCM's own receiver is not used: it believes the bytes that it gets (a channel without its final
/// NUL ends the process), keeps every channel name that it has heard, and hears other machines.
class UdpReceiver {
 public:
  static constexpr int kBufferBytes = 4 << 20;  // a default buffer, 208 kB, overflows in each burst

  /// Joins the group on the interface that the routing table gives for it, as LCM's sender does.
  /// Throws std::runtime_error if that fails.
  explicit UdpReceiver(const BusUrl& url);

  /// Returns the next datagram, or nothing after `timeout` or a signal ("bus.interrupted"). The
  /// bytes are valid until the next call.
  std::optional<std::span<const std::uint8_t>> next(std::chrono::milliseconds timeout,
                                                    Counters& counters);

  /// Returns a warning for the user if the kernel grants less than kBufferBytes; empty if not.
  std::string warning() const;

 private:
  void count_overflows(msghdr& message, Counters& counters);
  bool is_known(std::uint32_t address) const;  // in network byte order

  files::Descriptor socket_;
  std::uint32_t overflowed_ = 0;   // datagrams for which the buffer had no room
  std::set<std::uint32_t> known_;  // addresses of this machine and the peers
  std::array<std::uint8_t, 65536> bytes_;
};

}  // namespace rtg::bus

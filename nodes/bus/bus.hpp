#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "nodes/bus/counters.hpp"
#include "nodes/bus/wire.hpp"

namespace rtg::bus {

/// Version of the rules in msgs/CHANNELS.md.
inline constexpr std::int32_t kProtocol = 1;

/// The only C++ code that touches LCM.
///
/// LCM loses, doubles and reorders messages, and anyone may send: whatever arrives is checked
/// against its type, the run and finite values before a handler sees it; what is dropped is counted
/// ("bus.malformed", "bus.foreign_run", ...). publish() may be called from any thread; everything
/// else belongs to one thread.
class Bus {
 public:
  /// `url`: "udpm://GROUP:PORT[?ttl=N]" or "memq://" (one process, for tests). ttl is 0, this
  /// machine only, unless named. Only messages of the run named `run` are heard. Throws
  /// std::invalid_argument for an illegal URL, std::runtime_error if the network cannot be opened.
  Bus(const std::string& url, const std::string& run);
  ~Bus();
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;

  /// Fills the header and sends. A datagram that the kernel refuses counts as "bus.unsent", as lost
  /// as any other.
  template <class Msg>
  void publish(const std::string& channel, Msg msg) {
    msg.header = header_;
    send(channel, encode(msg));
  }

  template <class Msg>
  void subscribe(const std::string& channel, std::function<void(const Msg&)> handler) {
    listen(channel, [this, handler = std::move(handler)](std::span<const std::uint8_t> bytes) {
      Msg msg{};
      if (const auto defect = decode(bytes, msg))
        counters_.add(std::string(counter_name(*defect)));
      else if (is_ours(msg.header))
        handler(msg);
    });
  }

  /// Waits for a message for `timeout` at most, then handles all that have arrived. Returns how
  /// many; rethrows the first exception of a handler.
  int spin(std::chrono::milliseconds timeout);

  /// Sends bytes as they are; for tests of what a stranger may send.
  void send(const std::string& channel, std::span<const std::uint8_t> bytes);

  Counters& counters() { return counters_; }

 private:
  using RawHandler = std::function<void(std::span<const std::uint8_t>)>;
  struct Connection;

  void listen(const std::string& channel, RawHandler handler);
  bool is_ours(const rtg_msgs::header_t& header);

  Counters counters_;
  rtg_msgs::header_t header_{};
  std::unique_ptr<Connection> connection_;
};

}  // namespace rtg::bus

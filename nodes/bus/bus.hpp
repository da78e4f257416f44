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

/// A connection to the message bus; the only C++ class that uses LCM.
///
/// LCM loses, duplicates and reorders messages, and any process may send them. The Bus therefore
/// checks each message. Handlers receive only messages of the expected type, run and protocol whose
/// numbers are finite. The Bus drops all others and counts them ("bus.malformed",
/// "bus.foreign_run", ...).
///
/// publish() may be called from any thread, all other functions from one thread only.
class Bus {
 public:
  /// `url`: "udpm://GROUP:PORT[?ttl=N]", or "memq://" within one process, for tests. The default
  /// ttl of 0 keeps messages on this machine. `run`: name of the run; messages of other runs are
  /// dropped. Throws std::invalid_argument for an illegal URL, std::runtime_error if the network
  /// cannot be opened.
  Bus(const std::string& url, const std::string& run);
  ~Bus();
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;

  /// Fills the header of `msg` and sends `msg`. If the kernel refuses the datagram, the message is
  /// lost and counted as "bus.unsent".
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

  /// Waits up to `timeout` for a message. Then handles all messages that have arrived, at most
  /// 1000, and returns their number. Rethrows the first exception of a handler.
  int spin(std::chrono::milliseconds timeout);

  /// Sends `bytes` unchanged; public for tests with malformed or foreign messages.
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

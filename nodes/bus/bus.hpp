#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "nodes/bus/counters.hpp"
#include "nodes/bus/datagram.hpp"
#include "nodes/bus/network.hpp"
#include "nodes/bus/run_key.hpp"
#include "nodes/bus/wire.hpp"

namespace rtg::bus {

/// Version of the rules in msgs/CHANNELS.md.
inline constexpr std::int32_t kProtocol = 2;

/// A connection of one process to the messages of its run; the only C++ class that uses LCM.
///
/// LCM loses, duplicates and reorders messages, and any process may send them. The Bus therefore
/// checks each message, in this order: the datagram, the sender's machine, the run, the keyed hash,
/// the type, the counts, and that all numbers are finite. Handlers receive what passes; the Bus
/// drops all others and counts them ("bus.malformed", "bus.foreign_run", "bus.forged", ...).
///
/// publish() may be called from any thread, all other functions from one thread only.
class Bus {
 public:
  /// `url`: see parse_bus_url(). `key`: that of the run, whose messages alone are heard. Throws
  /// std::invalid_argument for an illegal URL, std::runtime_error if the network cannot be opened
  /// or does not bring back what is sent.
  Bus(const std::string& url, RunKey key);
  /// Returns a bus that hears what claims to be of the run named `run`, unauthenticated, and sends
  /// nothing: for displays, which need no key. Throws like the constructor.
  static Bus listener(const std::string& url, const std::string& run);
  ~Bus();
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;

  /// Fills the header of `msg` and sends `msg` with the hash of the run's key. If the kernel
  /// refuses the datagram, the message is lost and counted as "bus.unsent". A listener throws
  /// std::logic_error. `copies`: how often the message is sent.
  template <class Msg>
  void publish(const std::string& channel, Msg msg, int copies = 1) {
    msg.header = header_;
    send_sealed(channel, encode(msg), copies);
  }

  /// Makes spin() pass the messages of `channel` to `handler`, also to earlier ones. A handler must
  /// not call subscribe() or unsubscribe().
  template <class Msg>
  void subscribe(const std::string& channel, std::function<void(const Msg&)> handler) {
    handlers_[channel].push_back(
        [this, handler = std::move(handler)](std::span<const std::uint8_t> bytes) {
          Msg msg{};
          if (const auto defect = decode(bytes, msg))
            counters_.add(std::string(counter_name(*defect)));
          else if (msg.header.protocol != kProtocol)
            counters_.add("bus.foreign_protocol");
          else
            handler(msg);
        });
  }

  /// Waits up to `timeout` for a message. Then handles all messages that have arrived, at most
  /// 1000, and returns their number. Lets the exceptions of handlers through; the next call goes on
  /// with the next message.
  int spin(std::chrono::milliseconds timeout);

  /// Forgets all handlers.
  void unsubscribe() { handlers_.clear(); }

  /// Sends `bytes` unchanged; public for tests with malformed or foreign messages.
  void send(const std::string& channel, std::span<const std::uint8_t> bytes);

  Counters& counters() { return counters_; }
  /// Returns the name of the run.
  const std::string& run() const { return run_; }
  /// Returns a warning for the user about the network; empty if there is none.
  std::string warning() const;

 private:
  using Handler = std::function<void(std::span<const std::uint8_t>)>;

  Bus(const std::string& url, std::string run);
  void send_sealed(const std::string& channel, std::vector<std::uint8_t> bytes, int copies);
  Network::Verdict handle(const Datagram& datagram);

  std::string run_;
  std::optional<RunKey> key_;  // none: a listener
  rtg_msgs::header_t header_{};
  Counters counters_;
  std::unique_ptr<Network> network_;
  std::map<std::string, std::vector<Handler>, std::less<>> handlers_;
};

}  // namespace rtg::bus

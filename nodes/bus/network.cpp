#include "nodes/bus/network.hpp"

#include <sodium.h>

#include <algorithm>
#include <array>
#include <condition_variable>
#include <deque>
#include <lcm/lcm-cpp.hpp>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>

#include "nodes/bus/clock.hpp"
#include "nodes/bus/udp_receiver.hpp"

namespace rtg::bus {
namespace {

using namespace std::chrono_literals;
using Bytes = std::vector<std::uint8_t>;

constexpr int kMostPerSpin = 1000;  // datagrams; a flood of them must not block the caller
constexpr const char* kEchoChannel = "RTG_ECHO";
constexpr Seconds kEchoLimit = 2.0;
constexpr auto kEchoWait = 50ms;
constexpr auto kNap = 2ms;

class UdpNetwork : public Network {
 public:
  explicit UdpNetwork(const BusUrl& url)
      : receiver_(url),
        lcm_("udpm://" + url.group + ":" + std::to_string(url.port) +
             "?ttl=" + std::to_string(url.ttl)) {
    if (!lcm_.good()) throw std::runtime_error("bus: LCM cannot send to " + url.group);
    if (!brings_back())
      throw std::runtime_error(std::string("bus: messages sent do not come back from multicast. ") +
                               kMulticastRemedy);
  }

  bool send(const std::string& channel, std::span<const std::uint8_t> payload) override {
    return lcm_.publish(channel, payload.data(), static_cast<unsigned>(payload.size())) == 0;
  }

  std::string warning() const override { return receiver_.warning(); }

 private:
  std::optional<std::span<const std::uint8_t>> next(std::chrono::milliseconds timeout,
                                                    Counters& counters) override {
    return receiver_.next(timeout, counters);
  }

  /// Sends a random token until it arrives here. Drops what else arrives.
  bool brings_back() {
    std::array<std::uint8_t, 16> token;
    randombytes_buf(token.data(), token.size());
    Counters ignored;
    for (const Seconds end = monotonic_now() + kEchoLimit; monotonic_now() < end;) {
      send(kEchoChannel, token);
      const auto is_ours = [&](const Datagram& datagram) {
        return std::ranges::equal(datagram.payload, token) ? Verdict::kHandled : Verdict::kIgnored;
      };
      if (spin(kEchoWait, ignored, is_ours) > 0) return true;
    }
    return false;
  }

  UdpReceiver receiver_;
  lcm::LCM lcm_;  // after it, as LCM has words of its own for a network without multicast
};

/// A queue of datagrams.
class LocalNetwork : public Network {
 public:
  bool send(const std::string& channel, std::span<const std::uint8_t> payload) override {
    Bytes bytes{'L', 'C', '0', '2', 0, 0, 0, 0};
    bytes.insert(bytes.end(), channel.begin(), channel.end());
    bytes.push_back(0);
    bytes.insert(bytes.end(), payload.begin(), payload.end());
    {
      const std::scoped_lock lock(mutex_);
      waiting_.push_back(std::move(bytes));
    }
    arrived_.notify_one();
    return true;
  }

 private:
  std::optional<std::span<const std::uint8_t>> next(std::chrono::milliseconds timeout,
                                                    Counters&) override {
    std::unique_lock lock(mutex_);
    if (timeout > 0ms)  // a wait of 0 would put the thread to sleep for a moment
      arrived_.wait_for(lock, timeout, [this] { return !waiting_.empty(); });
    if (waiting_.empty()) return std::nullopt;
    current_ = std::move(waiting_.front());
    waiting_.pop_front();
    return current_;
  }

  std::mutex mutex_;  // guards the members below
  std::condition_variable arrived_;
  std::deque<Bytes> waiting_;
  Bytes current_;
};

Network::Verdict judge(std::span<const std::uint8_t> bytes, Counters& counters,
                       const Network::Handler& handle) {
  if (const auto datagram = parse_datagram(bytes)) return handle(*datagram);
  counters.add("bus.malformed");
  return Network::Verdict::kRefused;
}

}  // namespace

int Network::spin(std::chrono::milliseconds timeout, Counters& counters, const Handler& handle) {
  using std::chrono::duration;
  const Seconds end = monotonic_now() + duration<double>(timeout).count();
  int handled = 0;
  bool refused = false;  // the last datagram
  for (int heard = 0; heard < kMostPerSpin; ++heard) {
    auto bytes = next(0ms, counters);
    const duration<double> left(end - monotonic_now());
    if (!bytes && handled == 0 && left.count() > 0.0) {
      if (std::exchange(refused, false)) std::this_thread::sleep_for(kNap);
      bytes = next(std::chrono::ceil<std::chrono::milliseconds>(left), counters);
    }
    if (!bytes) break;
    const Verdict verdict = bytes->empty() ? Verdict::kRefused : judge(*bytes, counters, handle);
    handled += verdict == Verdict::kHandled;
    refused = verdict == Verdict::kRefused;
  }
  return handled;
}

std::unique_ptr<Network> open_network(const std::string& url) {
  const BusUrl parsed = parse_bus_url(url);
  if (parsed.in_process) return std::make_unique<LocalNetwork>();
  return std::make_unique<UdpNetwork>(parsed);
}

}  // namespace rtg::bus

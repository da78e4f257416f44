#include "nodes/bus/bus.hpp"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdio>
#include <exception>
#include <lcm/lcm-cpp.hpp>
#include <list>
#include <stdexcept>
#include <utility>

#include "nodes/bus/bus_url.hpp"
#include "nodes/bus/content_hash.hpp"

namespace rtg::bus {
namespace {

constexpr int kQueueCapacity = 1000;  // messages; LCM silently drops more, by default beyond 30
constexpr int kMaxPerSpin = 1000;     // messages; a flood of messages must not block the caller

/// Returns the receive buffer size of the UDP socket bound to `port` [bytes]; 0 if there is none.
/// Searches the file descriptors, because LCM does not expose its own.
int receive_buffer(int port) {
  for (int fd = 3; fd < 256; ++fd) {
    sockaddr_in address{};
    socklen_t length = sizeof address;
    if (getsockname(fd, reinterpret_cast<sockaddr*>(&address), &length) != 0 ||
        address.sin_family != AF_INET || ntohs(address.sin_port) != port)
      continue;
    int size = 0;
    length = sizeof size;
    if (getsockopt(fd, SOL_SOCKET, SO_RCVBUF, &size, &length) == 0) return size;
  }
  return 0;
}

void warn_of_small_buffer(const std::string& url) {
  if (!url.starts_with("udpm")) return;
  const int port = std::stoi(url.substr(url.find(':', 7) + 1));
  const int size = receive_buffer(port) / 2;  // Linux reports twice the requested size
  if (size >= kReceiveBuffer) return;
  std::fprintf(stderr,
               "bus: receive buffer is %d kB instead of %d kB; bursts will be lost and sent again. "
               "To raise it: sysctl -w net.core.rmem_max=%d\n",
               size >> 10, kReceiveBuffer >> 10, kReceiveBuffer);
}

}  // namespace

struct Bus::Connection {
  explicit Connection(const std::string& bus_url) : url(bus_url), lcm(bus_url) {}

  /// A subscription to one channel.
  struct Listener {
    Connection* connection;
    RawHandler handler;
  };

  /// Callback that LCM's C code calls. Stores an exception of the handler in `failure`, because no
  /// exception may propagate through C code.
  static void receive(const lcm_recv_buf_t* buffer, const char*, void* user) {
    const auto& listener = *static_cast<Listener*>(user);
    try {
      listener.handler({static_cast<const std::uint8_t*>(buffer->data), buffer->data_size});
    } catch (...) {
      auto& failure = listener.connection->failure;
      if (!failure) failure = std::current_exception();
    }
  }

  std::string url;
  lcm::LCM lcm;
  std::list<Listener> listeners;  // std::list: LCM stores their addresses
  std::exception_ptr failure;
};

Bus::Bus(const std::string& url, const std::string& run)
    : connection_(std::make_unique<Connection>(checked_bus_url(url))) {
  if (!connection_->lcm.good()) throw std::runtime_error("bus '" + url + "' cannot be opened");
  header_.protocol = kProtocol;
  header_.run = ContentHash().add(run).value();
  header_.sender = getpid();
}

Bus::~Bus() = default;

int Bus::spin(std::chrono::milliseconds timeout) {
  int wait = static_cast<int>(timeout.count());
  for (int handled = 0; handled < kMaxPerSpin; ++handled) {
    const int said = connection_->lcm.handleTimeout(wait);
    if (said < 0) counters_.add("bus.interrupted");
    if (said <= 0) return handled;
    wait = 0;
    if (connection_->failure) std::rethrow_exception(std::exchange(connection_->failure, nullptr));
  }
  return kMaxPerSpin;
}

void Bus::send(const std::string& channel, std::span<const std::uint8_t> bytes) {
  if (connection_->lcm.publish(channel, bytes.data(), static_cast<unsigned>(bytes.size())) != 0)
    counters_.add("bus.unsent");
}

void Bus::listen(const std::string& channel, RawHandler handler) {
  auto& listener = connection_->listeners.emplace_back(connection_.get(), std::move(handler));
  // lcm::LCM::subscribe() is not used: it hides a failed self-test, and GCC 12's
  // UndefinedBehaviorSanitizer reports a false positive for its call through a member pointer.
  lcm_subscription_t* const subscription = lcm_subscribe(
      connection_->lcm.getUnderlyingLCM(), channel.c_str(), &Connection::receive, &listener);
  if (!subscription)
    throw std::runtime_error(
        "bus: messages sent do not come back; is multicast enabled on this machine? "
        "(ip link set lo multicast on; ip route add 224.0.0.0/4 dev lo)");
  lcm_subscription_set_queue_capacity(subscription, kQueueCapacity);
  if (connection_->listeners.size() == 1) warn_of_small_buffer(connection_->url);
}

bool Bus::is_ours(const rtg_msgs::header_t& header) {
  if (header.run != header_.run) return counters_.add("bus.foreign_run"), false;
  if (header.protocol != kProtocol) return counters_.add("bus.foreign_protocol"), false;
  return true;
}

}  // namespace rtg::bus

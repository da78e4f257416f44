#include "nodes/bus/udp_receiver.hpp"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <system_error>

namespace rtg::bus {
namespace {

std::uint32_t ipv4(const std::string& address) { return inet_addr(address.c_str()); }

sockaddr_in internet_address(std::uint32_t address, std::uint16_t port) {
  sockaddr_in out{};
  out.sin_family = AF_INET;
  out.sin_addr.s_addr = address;
  out.sin_port = htons(port);
  return out;
}

/// Returns the addresses of this machine. 0.0.0.0 is the source of a datagram on an interface
/// without an address; the kernel accepts none with it, or with one of ours, from outside.
std::set<std::uint32_t> own_addresses() {
  std::set<std::uint32_t> found{INADDR_ANY};
  ifaddrs* list = nullptr;
  if (getifaddrs(&list) != 0) return found;
  const std::unique_ptr<ifaddrs, decltype(&freeifaddrs)> owner(list, &freeifaddrs);
  for (const ifaddrs* entry = list; entry; entry = entry->ifa_next)
    if (entry->ifa_addr && entry->ifa_addr->sa_family == AF_INET)
      found.insert(reinterpret_cast<const sockaddr_in*>(entry->ifa_addr)->sin_addr.s_addr);
  return found;
}

template <class Value>
bool set(int socket, int level, int option, const Value& value) {
  return setsockopt(socket, level, option, &value, sizeof value) == 0;
}

bool join(int socket, const BusUrl& url) {
  const sockaddr_in address = internet_address(ipv4(url.group), url.port);
  const ip_mreq membership{{ipv4(url.group)}, {INADDR_ANY}};
  return set(socket, SOL_SOCKET, SO_REUSEADDR, 1) &&
         set(socket, SOL_SOCKET, SO_RCVBUF, UdpReceiver::kBufferBytes) &&
         set(socket, SOL_SOCKET, SO_RXQ_OVFL, 1) &&
         set(socket, IPPROTO_IP, IP_MULTICAST_ALL, 0) &&  // groups that others have joined
         bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 &&
         set(socket, IPPROTO_IP, IP_ADD_MEMBERSHIP, membership);
}

}  // namespace

UdpReceiver::UdpReceiver(const BusUrl& url)
    : socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)),
      known_(own_addresses()) {
  if (!socket_ || !join(socket_.number(), url))
    throw std::runtime_error("bus: multicast group " + url.group + " cannot be joined: " +
                             std::generic_category().message(errno) + ". " + kMulticastRemedy);
  for (const std::string& peer : url.peers) known_.insert(ipv4(peer));
}

std::optional<std::span<const std::uint8_t>> UdpReceiver::next(std::chrono::milliseconds timeout,
                                                               Counters& counters) {
  if (timeout.count() > 0) {
    pollfd ready{socket_.number(), POLLIN, 0};
    if (poll(&ready, 1, static_cast<int>(timeout.count())) < 0) counters.add("bus.interrupted");
  }
  sockaddr_in from{};
  iovec bytes{bytes_.data(), bytes_.size()};
  alignas(cmsghdr) std::array<std::uint8_t, CMSG_SPACE(sizeof overflowed_)> control;
  msghdr message{&from, sizeof from, &bytes, 1, control.data(), control.size(), 0};
  const ssize_t size = recvmsg(socket_.number(), &message, 0);
  if (size < 0) return std::nullopt;  // none, or a wrong checksum, which the kernel drops
  count_overflows(message, counters);
  const bool known = is_known(from.sin_addr.s_addr);
  if (known && size > 0) return std::span(bytes_).first(static_cast<std::size_t>(size));
  counters.add(known ? "bus.malformed" : "bus.stranger");
  return std::span<const std::uint8_t>();
}

/// The kernel tells with each datagram how many it has dropped so far, modulo 2³².
void UdpReceiver::count_overflows(msghdr& message, Counters& counters) {
  const cmsghdr* head = CMSG_FIRSTHDR(&message);
  if (!head || head->cmsg_level != SOL_SOCKET || head->cmsg_type != SO_RXQ_OVFL) return;
  std::uint32_t dropped = 0;
  std::memcpy(&dropped, CMSG_DATA(head), sizeof dropped);
  if (dropped != overflowed_) counters.add("bus.overflowed", dropped - overflowed_);
  overflowed_ = dropped;
}

std::string UdpReceiver::warning() const {
  int size = 0;
  socklen_t length = sizeof size;
  getsockopt(socket_.number(), SOL_SOCKET, SO_RCVBUF, &size, &length);
  size /= 2;  // Linux reports twice the requested size
  if (size >= kBufferBytes) return "";
  return "bus: receive buffer is " + std::to_string(size >> 10) + " kB instead of " +
         std::to_string(kBufferBytes >> 10) +
         " kB; bursts will be lost and sent again. To raise it: sysctl -w net.core.rmem_max=" +
         std::to_string(kBufferBytes);
}

bool UdpReceiver::is_known(std::uint32_t address) const {
  return known_.contains(address) || (ntohl(address) >> 24) == IN_LOOPBACKNET;
}

}  // namespace rtg::bus

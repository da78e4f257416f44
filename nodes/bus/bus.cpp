#include "nodes/bus/bus.hpp"

#include <unistd.h>

#include <stdexcept>
#include <utility>

#include "nodes/bus/network.hpp"

namespace rtg::bus {

Bus::Bus(const std::string& url, RunKey key)
    : run_(key.name()), key_(std::move(key)), network_(open_network(url)) {
  header_.protocol = kProtocol;
  header_.run = run_id(run_);
  header_.sender = getpid();
}

Bus::Bus(const std::string& url, std::string run)
    : run_(std::move(run)), network_(open_network(url)) {
  header_.run = run_id(run_);
}

Bus Bus::listener(const std::string& url, const std::string& run) { return {url, run}; }

Bus::~Bus() = default;

int Bus::spin(std::chrono::milliseconds timeout) {
  return network_->spin(timeout, counters_,
                        [this](const Datagram& datagram) { return handle(datagram); });
}

void Bus::send(const std::string& channel, std::span<const std::uint8_t> bytes) {
  if (!network_->send(channel, bytes)) counters_.add("bus.unsent");
}

std::string Bus::warning() const { return network_->warning(); }

void Bus::send_sealed(const std::string& channel, std::vector<std::uint8_t> bytes, int copies) {
  if (!key_) throw std::logic_error("bus: a listener sends nothing");
  key_->seal(channel, bytes);
  for (int k = 0; k < copies; ++k) send(channel, bytes);
}

/// Passes a message of this run to the handlers of its channel.
Network::Verdict Bus::handle(const Datagram& datagram) {
  using enum Network::Verdict;
  const auto handlers = handlers_.find(datagram.channel);
  if (handlers == handlers_.end()) return kIgnored;
  if (run_of(datagram.payload) != header_.run) return counters_.add("bus.foreign_run"), kRefused;
  const auto message =
      key_ ? key_->opened(datagram.channel, datagram.payload) : without_tag(datagram.payload);
  if (!message) return counters_.add("bus.forged"), kRefused;
  for (const Handler& handler : handlers->second) handler(*message);
  return kHandled;
}

}  // namespace rtg::bus

// The bytes of a datagram, on their way from the network to the handlers of all types of messages.
#include "nodes/bus/datagram.hpp"

#include <algorithm>

#include "nodes/bus/bus.hpp"
#include "tests/fuzz/sealed.hpp"
#include "tests/fuzz/target.hpp"
#include "tests/nodes/bus/filled_message.hpp"

namespace rtg::fuzz {
namespace {

/// A message of each type, on a channel that has the name of the type.
template <class... Msg>
struct Types {
  template <class Use>
  static void each(const Use& use) {
    (use.template operator()<Msg>(), ...);
  }
};
using EveryType = rtg_msgs::EveryMessage<Types>;

/// Subscribes to all types. `payload`: that of the datagram in work.
void hear_all(bus::Bus& bus, const std::span<const std::uint8_t>& payload) {
  EveryType::each([&]<class Msg>() {
    bus.subscribe<Msg>(Msg::getTypeName(), [&payload](const Msg& message) {
      Msg copy = message;
      require(std::ranges::equal(bus::encode(copy),
                                 payload.first(payload.size() - bus::RunKey::kTagBytes)),
              "a message that is heard has one encoding");
    });
  });
}

void check(const bus::Datagram& datagram) {
  static std::span<const std::uint8_t> payload;
  static bus::Bus& keyed = *[] {
    auto* bus = new bus::Bus("memq://", fixed_key());
    hear_all(*bus, payload);
    return bus;
  }();
  static bus::Bus& listener = *[] {
    auto* bus = new bus::Bus(bus::Bus::listener("memq://", fixed_key().name()));
    hear_all(*bus, payload);
    return bus;
  }();
  payload = datagram.payload;
  for (bus::Bus* bus : {&keyed, &listener}) {
    bus->send(std::string(datagram.channel), payload);
    bus->spin(std::chrono::milliseconds(0));
  }
}

}  // namespace

std::vector<Bytes> seeds() {
  std::vector<Bytes> all;
  EveryType::each([&]<class Msg>() {
    Msg message = testing::filled<Msg>(2);
    message.header.protocol = bus::kProtocol;
    message.header.run = bus::run_id(fixed_key().name());
    Bytes payload = bus::encode(message);
    fixed_key().seal(Msg::getTypeName(), payload);
    all.push_back(datagram_of(Msg::getTypeName(), payload));
  });
  return all;
}

}  // namespace rtg::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span bytes(data, size);
  const auto datagram = rtg::bus::parse_datagram(bytes);
  if (!datagram) return 0;
  rtg::fuzz::require(8 + datagram->channel.size() + 1 + datagram->payload.size() == size,
                     "channel and payload fill the datagram");
  rtg::fuzz::check(*datagram);
  return 0;
}

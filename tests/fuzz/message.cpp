// Messages of a holder of the key, one after another, to all that hear them: coordinator, workers
// and the stream. An input is a list of messages: the number of the type, the length of the rest in
// two bytes, the rest, which is the message behind its header.
#include <algorithm>
#include <array>
#include <bit>

#include "nodes/beam_coordinator/job_pool.hpp"
#include "nodes/beam_coordinator/transition_publisher.hpp"
#include "nodes/jobs/worker_node.hpp"
#include "tests/fuzz/reverse_results.hpp"
#include "tests/fuzz/sealed.hpp"
#include "tests/fuzz/target.hpp"
#include "tests/nodes/bus/filled_message.hpp"

namespace rtg::fuzz {
namespace {

using jobs::ReplayService;
using jobs::ReverseService;

constexpr jobs::TaskShape kShape{.bodies = 2, .actions = 4};
constexpr std::int64_t kConfig = 3, kStream = 5;
constexpr std::size_t kFront = 8 + 16;   // fingerprint and header
constexpr std::size_t kTo = kFront + 8;  // of a job: who it is for
constexpr int kMostMessages = 32;

/// A type of message and its channel.
struct Kind {
  const char* channel;
  std::int64_t (*fingerprint)();
};
template <class Msg>
constexpr Kind kind(const char* channel) {
  return {channel, &Msg::getHash};
}
const std::array kKinds{
    kind<rtg_msgs::worker_beat_t>(ReverseService::kBeats),
    kind<rtg_msgs::worker_beat_t>(ReplayService::kBeats),
    kind<rtg_msgs::reverse_job_t>(ReverseService::kJobs),
    kind<rtg_msgs::replay_job_t>(ReplayService::kJobs),
    kind<rtg_msgs::reverse_result_t>(ReverseService::kResults),
    kind<rtg_msgs::replay_result_t>(ReplayService::kResults),
    kind<rtg_msgs::stream_ack_t>("RTG_ACK"),
    kind<rtg_msgs::search_progress_t>("RTG_PROGRESS"),
};

template <class Service>
using Node = jobs::WorkerNode<Service>;

/// A worker that computes nothing: its threads would only make the inputs slow.
template <class Service>
typename Node<Service>::Options idle() {
  return {.shape = kShape, .config = kConfig, .threads = 0};
}

/// All that hears messages, on a bus of its own. Units of both kinds wait for an answer.
struct Listeners {
  bus::Bus bus{"memq://", fixed_key()};
  beam_coordinator::JobPool<ReverseService> reverse{bus, kShape, kConfig};
  beam_coordinator::JobPool<ReplayService> replay{bus, kShape, kConfig};
  beam_coordinator::TransitionPublisher transitions{bus, kShape, kStream};
  Node<ReverseService> solver{bus, idle<ReverseService>(), {}};
  Node<ReplayService> simulator{bus, idle<ReplayService>(), {}};

  Listeners() {
    hear_results<ReverseService>();
    hear_results<ReplayService>();
    transitions.store(std::vector<search::Transition>(40, {Poses(2), 1, Poses(2)}));
  }

  /// Requires what the pools rely on when a result is that of one of their units.
  template <class Service>
  void hear_results() {
    using Message = typename Service::ResultMessage;
    bus.subscribe<Message>(Service::kResults, [](const Message& message) {
      const auto results = Service::parse(message, kShape);
      require(!results || results->size() == static_cast<std::size_t>(message.n),
              "a legal message has its results");
    });
  }

  void tick() {
    const bus::Seconds now = bus::monotonic_now();
    reverse.tick();
    replay.tick();
    transitions.tick(now);
    solver.tick(now);
    simulator.tick(now);
  }
};

void put(Bytes& message, std::size_t at, std::int64_t value) {
  for (std::size_t k = 0; k < 8 && at + k < message.size(); ++k)
    message[at + k] = static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (56 - 8 * k));
}

/// Returns the sealed message of `kind` whose fields behind the header are `rest`.
Bytes message_of(const Kind& kind, std::span<const std::uint8_t> rest, const Listeners& to) {
  rtg_msgs::header_t header{bus::kProtocol, bus::run_id(fixed_key().name()), 1};
  Bytes message(kFront);
  put(message, 0, kind.fingerprint());
  header._encodeNoHash(message.data(), 8, 16);
  message.insert(message.end(), rest.begin(), rest.end());
  if (kind.channel == std::string_view(ReverseService::kJobs))
    put(message, kTo, to.solver.incarnation());
  if (kind.channel == std::string_view(ReplayService::kJobs))
    put(message, kTo, to.simulator.incarnation());
  fixed_key().seal(kind.channel, message);
  return message;
}

void check(std::span<const std::uint8_t> bytes) {
  Listeners all;
  for (int k = 0; k < kMostMessages && bytes.size() >= 3; ++k) {
    const Kind& kind = kKinds[bytes[0] % kKinds.size()];
    const std::size_t length = std::min<std::size_t>(bytes[1] + 256U * bytes[2], bytes.size() - 3);
    all.bus.send(kind.channel, message_of(kind, bytes.subspan(3, length), all));
    while (all.bus.spin(std::chrono::milliseconds(0)) > 0) {
    }
    all.tick();
    bytes = bytes.subspan(3 + length);
  }
}

template <class Msg>
void append(Bytes& out, const char* channel, const Msg& message) {
  Msg copy = message;
  const Bytes bytes = bus::encode(copy);
  const auto kind = std::ranges::find(kKinds, std::string_view(channel),
                                      [](const Kind& k) { return std::string_view(k.channel); });
  const std::size_t length = bytes.size() - kFront;
  out.push_back(static_cast<std::uint8_t>(kind - kKinds.begin()));
  out.push_back(static_cast<std::uint8_t>(length));
  out.push_back(static_cast<std::uint8_t>(length >> 8));
  out.insert(out.end(), bytes.begin() + kFront, bytes.end());
}

rtg_msgs::worker_beat_t beat() {
  auto message = testing::filled<rtg_msgs::worker_beat_t>(2);
  message.config = kConfig;
  message.capacity = 4;
  return message;
}

rtg_msgs::stream_ack_t acknowledgement() {
  rtg_msgs::stream_ack_t message{};
  message.stream = kStream;
  message.cursor = 10;
  message.credit = 20;
  message.first = {12, 17};
  message.last = {14, 17};
  message.n = 2;
  return message;
}

template <class Service, class Item>
void append_work(Bytes& out, const char* channel, const std::vector<Item>& items) {
  append(out, channel, Service::message(std::span<const Item>(items)));
}

Bytes work() {
  Bytes out;
  append(out, ReverseService::kBeats, beat());
  append(out, ReplayService::kBeats, beat());
  append_work<ReverseService, reverse::ReverseJob>(out, ReverseService::kJobs,
                                                   {{Poses(2), 1, true}, {Poses(2), 3}});
  append_work<ReplayService, search::ReplayJob>(out, ReplayService::kJobs,
                                                {{Poses(2), 0}, {Poses(2), search::kSettle}});
  return out;
}

Bytes answers() {
  Bytes out;
  append_work<ReverseService, reverse::ReverseResult>(out, ReverseService::kResults,
                                                      reverse_results());
  append_work<ReplayService, search::ReplayResult>(out, ReplayService::kResults,
                                                   {{Poses(2), true, 0.1}, {Poses(2), false}});
  return out;
}

Bytes stream() {
  Bytes out;
  append(out, "RTG_ACK", acknowledgement());
  append(out, "RTG_PROGRESS", testing::filled<rtg_msgs::search_progress_t>());
  return out;
}

}  // namespace

std::vector<Bytes> seeds() { return {work(), answers(), stream()}; }

}  // namespace rtg::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  rtg::fuzz::check({data, size});
  return 0;
}

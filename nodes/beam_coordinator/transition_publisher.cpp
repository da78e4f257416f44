#include "nodes/beam_coordinator/transition_publisher.hpp"

#include <utility>

#include "nodes/jobs/flat_poses.hpp"

namespace rtg::beam_coordinator {
namespace {

/// Returns the encoded size of one transition [bytes]: two states, action, success, source.
std::int64_t row_bytes(const jobs::TaskShape& shape) {
  return std::int64_t{2} * shape.bodies * 24 + 6;
}

}  // namespace

TransitionPublisher::TransitionPublisher(bus::Bus& bus, const jobs::TaskShape& shape,
                                         std::int64_t stream)
    : bus_(bus), stream_(stream), server_({}, row_bytes(shape)) {
  using rtg_msgs::stream_ack_t;
  bus_.subscribe<stream_ack_t>("RTG_ACK", [this](const stream_ack_t& m) { on_ack(m); });
}

void TransitionPublisher::store(std::span<const search::Transition> rows) {
  const std::scoped_lock lock(mutex_);
  server_.append(rows);
}

void TransitionPublisher::seal() {
  const std::scoped_lock lock(mutex_);
  server_.seal();
  tail_.hurry();  // consumers learn it at the next tick()
}

void TransitionPublisher::tick(bus::Seconds now) {
  const std::scoped_lock lock(mutex_);
  for (const stream::RowRange& range : server_.due(now)) send(range);
  if (!tail_.due(now)) return;
  rtg_msgs::stream_tail_t message{};
  message.stream = stream_;
  message.count = server_.count();
  message.sealed = server_.sealed();
  bus_.publish("RTG_TAIL", message);
}

bool TransitionPublisher::backlog(bus::Seconds now) const {
  const std::scoped_lock lock(mutex_);
  return server_.backlog(now);
}

bool TransitionPublisher::drained(int consumers, bus::Seconds now) const {
  const std::scoped_lock lock(mutex_);
  return server_.drained(consumers, now);
}

TransitionPublisher::State TransitionPublisher::state() const {
  const std::scoped_lock lock(mutex_);
  return {server_.count(), server_.slowest_cursor(), server_.consumers(), server_.resent(),
          server_.sealed()};
}

void TransitionPublisher::on_ack(const rtg_msgs::stream_ack_t& message) {
  if (message.stream != stream_) return bus_.counters().add("stream.other_stream");
  const std::scoped_lock lock(mutex_);
  // The consumer may have rows that a coordinator killed since has sent.
  if (!server_.sealed() && message.cursor > server_.count())
    return bus_.counters().add("stream.ack_ahead");
  std::vector<stream::RowRange> missing;
  for (std::size_t k = 0; k < message.first.size(); ++k)
    if (message.first[k] >= 0 && message.last[k] >= message.first[k] &&
        message.last[k] < server_.count())
      missing.push_back({message.first[k], message.last[k] + 1});
  if (!server_.on_ack({message.consumer, message.cursor, message.credit, missing},
                      bus::monotonic_now()))
    bus_.counters().add("stream.illegal_ack");
}

void TransitionPublisher::send(stream::RowRange range) {
  rtg_msgs::transition_batch_t message{};
  message.stream = stream_;
  message.first = range.begin;
  for (const search::Transition& t : server_.rows(range)) {
    jobs::append_poses(t.poses, message.poses);
    jobs::append_poses(t.next, message.next_poses);
    message.action.push_back(t.action);
    message.success.push_back(t.success ? 1 : 0);
    message.source.push_back(static_cast<std::int8_t>(t.source));
  }
  message.n = static_cast<std::int32_t>(message.action.size());
  message.n_poses = static_cast<std::int32_t>(message.poses.size());
  bus_.publish("RTG_TRANSITION", std::move(message));
}

}  // namespace rtg::beam_coordinator

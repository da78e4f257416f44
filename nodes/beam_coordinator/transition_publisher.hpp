#pragma once

#include <mutex>
#include <rtg_msgs/stream_ack_t.hpp>
#include <rtg_msgs/stream_tail_t.hpp>
#include <rtg_msgs/transition_batch_t.hpp>
#include <span>

#include "nodes/bus/bus.hpp"
#include "nodes/bus/clock.hpp"
#include "nodes/jobs/services.hpp"
#include "nodes/stream/stream_server.hpp"

namespace rtg::beam_coordinator {

/// Publishes the transition stream on the bus, by StreamServer. The search calls store() on its own
/// thread; the thread that spins the bus calls all other functions.
class TransitionPublisher {
 public:
  /// `stream`: identity of the stream. Streams with the same one have the same rows.
  TransitionPublisher(bus::Bus& bus, const jobs::TaskShape& shape, std::int64_t stream);

  void store(std::span<const search::Transition> rows);
  void seal();

  /// Sends the rows that are due. Sends the length of the stream (RTG_TAIL) five times a second,
  /// and at once when it is sealed.
  void tick(bus::Seconds now);

  /// Returns whether tick() will send more rows later without new events.
  bool backlog(bus::Seconds now) const;

  /// See StreamServer::drained().
  bool drained(int consumers, bus::Seconds now) const;

  struct State {
    std::int64_t rows = 0, slowest_cursor = 0;
    int consumers = 0;
    long resent = 0;  // rows
    bool sealed = false;
  };
  State state() const;

 private:
  void on_ack(const rtg_msgs::stream_ack_t& message);
  void send(stream::RowRange range);

  bus::Bus& bus_;
  std::int64_t stream_;
  bus::Ticker tail_{0.2};
  mutable std::mutex mutex_;  // guards the members below
  stream::StreamServer server_;
};

}  // namespace rtg::beam_coordinator

#pragma once

#include <mutex>
#include <rtg_msgs/stream_ack_t.hpp>
#include <rtg_msgs/stream_tail_t.hpp>
#include <rtg_msgs/transition_batch_t.hpp>
#include <span>

#include "nodes/beam_coordinator/stream_server.hpp"
#include "nodes/bus/bus.hpp"
#include "nodes/bus/clock.hpp"
#include "nodes/jobs/services.hpp"

namespace rtg::beam_coordinator {

/// The transition stream on the bus. The search calls store() on its thread; everything else
/// belongs to the thread that spins the bus.
class TransitionPublisher {
 public:
  TransitionPublisher(bus::Bus& bus, const jobs::TaskShape& shape);

  void store(std::span<const search::Transition> rows);
  void seal();

  /// Sends what is due, and how long the stream is.
  void tick(bus::Seconds now);

  /// Says whether tick() will have more to send although nothing new comes in.
  bool backlog(bus::Seconds now) const;

  /// As StreamServer::drained().
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
  void send(RowRange range);

  bus::Bus& bus_;
  std::int64_t stream_ = bus::random_identity();
  bus::Ticker tail_{0.2};
  mutable std::mutex mutex_;  // guards what follows
  StreamServer server_;
};

}  // namespace rtg::beam_coordinator

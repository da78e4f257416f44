#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "core/search/transition.hpp"
#include "nodes/bus/seconds.hpp"
#include "nodes/stream/row_range.hpp"

namespace rtg::stream {

/// The sending end of the transition stream, which keeps all rows in memory. Every consumer gets
/// every row, however many messages the network loses. The class does no I/O: the caller passes in
/// events and the time, and sends the row ranges that due() returns.
///
/// New rows are sent once, no faster than receive buffers can take. They stay within the credit of
/// every living consumer, the number of rows that it accepts. Rows are sent again only when a
/// consumer requests them.
class StreamServer {
 public:
  struct Limits {
    double rate = 10e6;                // [bytes/s]
    double burst = 64e3;               // sent at once [bytes]; a default receive buffer has 208 kB
    std::int64_t chunk_bytes = 16000;  // rows of one message [bytes]
    bus::Seconds silence = 2.0;        // nobody waits for a consumer silent for longer [s]
    std::int64_t max_nacked = 65536;   // rows that one acknowledgement may request
    std::int64_t max_credit = 1 << 20;
    std::size_t max_consumers = 1000;
  };
  struct Ack {
    std::int64_t consumer = 0;
    std::int64_t cursor = 0;  // rows below it have been received
    std::int64_t credit = 0;  // rows accepted beyond the cursor; 0: has the whole sealed stream
    std::span<const RowRange> missing;
  };

  /// `row_bytes`: size of one transition on the wire.
  StreamServer(const Limits& limits, std::int64_t row_bytes);

  void append(std::span<const search::Transition> rows);
  void seal() { sealed_ = true; }

  /// Takes note of `ack`. Returns false and ignores it if it contradicts the stream or the limits:
  /// negative numbers, a cursor beyond the end, too large a credit, one consumer too many.
  bool on_ack(const Ack& ack, bus::Seconds now);

  /// Returns the row ranges to send now, one per message.
  std::vector<RowRange> due(bus::Seconds now);

  std::span<const search::Transition> rows(RowRange range) const;
  std::int64_t count() const { return static_cast<std::int64_t>(rows_.size()); }
  std::int64_t rows_per_message() const { return rows_per_message_; }
  bool sealed() const { return sealed_; }
  int consumers() const { return static_cast<int>(consumers_.size()); }
  std::int64_t slowest_cursor() const;
  long resent() const { return resent_; }  // rows sent again on request

  /// Returns whether due() will return more ranges later without new events.
  bool backlog(bus::Seconds now) const {
    return !requested_.empty() || first_unsent_ < live_limit(now);
  }

  /// Returns whether the stream is sealed and sent, and its consumers have all of it. All living
  /// consumers must have confirmed that, and at least `consumers` in all, living or not.
  bool drained(int consumers, bus::Seconds now) const;

 private:
  struct Consumer {
    std::int64_t cursor = 0, credit = 0;
    bus::Seconds heard = 0.0;
    bool complete = false;
  };

  void ask(RowRange range);
  RowRange next(bus::Seconds now);
  std::int64_t live_limit(bus::Seconds now) const;

  Limits limits_;
  std::int64_t rows_per_message_;
  double row_bytes_;
  std::vector<search::Transition> rows_;
  bool sealed_ = false;
  std::int64_t first_unsent_ = 0;                   // rows below first_unsent_ have been sent once
  std::map<std::int64_t, std::int64_t> requested_;  // requested ranges, begin -> end, disjoint
  std::map<std::int64_t, Consumer> consumers_;
  double tokens_ = 0.0;  // [bytes]
  bus::Seconds refilled_ = 0.0;
  long resent_ = 0;
};

}  // namespace rtg::stream

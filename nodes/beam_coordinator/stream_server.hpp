#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "core/search/transition.hpp"
#include "nodes/bus/seconds.hpp"

namespace rtg::beam_coordinator {

/// Half-open range of sequence numbers.
struct RowRange {
  std::int64_t begin = 0, end = 0;

  bool operator==(const RowRange&) const = default;
};

/// The sending end of the transition stream, a sequence of rows without gaps that is kept in
/// memory. Every consumer gets every row, however many messages the network loses. The class does
/// no I/O: the caller passes in events and the time, and sends the row ranges that due() returns.
///
/// New rows are sent once, at a rate that receive buffers can take, and not beyond the credit of
/// any living consumer. After that a row is sent again only when a consumer requests it.
class StreamServer {
 public:
  struct Limits {
    double rate = 10e6;                // [bytes/s]
    double burst = 64e3;               // [bytes] at once; a default receive buffer holds 208 kB
    std::int64_t chunk_bytes = 16000;  // rows of one message [bytes]
    bus::Seconds silence = 2.0;        // a consumer silent for longer is no longer waited for
    std::int64_t max_nacked = 65536;   // rows that one acknowledgement may request
  };
  struct Ack {
    std::int64_t consumer = 0;
    std::int64_t cursor = 0;
    std::int64_t credit = 0;  // rows beyond the cursor; 0: the consumer has the sealed stream
    std::span<const RowRange> missing;
  };

  /// `row_bytes`: size of one transition on the wire.
  StreamServer(const Limits& limits, std::int64_t row_bytes);

  void append(std::span<const search::Transition> rows);
  void seal() { sealed_ = true; }

  /// Applies `ack`. Returns false and ignores `ack` if it contradicts the stream: negative numbers,
  /// a cursor beyond the end.
  bool on_ack(const Ack& ack, bus::Seconds now);

  /// Returns the messages to send now, each a range of at most rows_per_message() rows.
  std::vector<RowRange> due(bus::Seconds now);

  std::span<const search::Transition> rows(RowRange range) const;
  std::int64_t count() const { return static_cast<std::int64_t>(rows_.size()); }
  std::int64_t rows_per_message() const { return rows_per_message_; }
  bool sealed() const { return sealed_; }
  int consumers() const { return static_cast<int>(consumers_.size()); }
  std::int64_t slowest_cursor() const;
  long resent() const { return resent_; }  // rows sent again on request

  /// Returns whether due() will have more to send without new events.
  bool backlog(bus::Seconds now) const { return !asked_.empty() || live_ < live_limit(now); }

  /// Returns whether the whole sealed stream has been sent, and at least `consumers` consumers and
  /// all living ones have confirmed that they have it.
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
  std::int64_t live_ = 0;                       // rows below live_ have been sent once
  std::map<std::int64_t, std::int64_t> asked_;  // requested ranges, begin -> end, disjoint
  std::map<std::int64_t, Consumer> consumers_;
  double tokens_ = 0.0;  // [bytes]
  bus::Seconds refilled_ = 0.0;
  long resent_ = 0;
};

}  // namespace rtg::beam_coordinator

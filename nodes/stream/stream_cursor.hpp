#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "nodes/bus/seconds.hpp"
#include "nodes/stream/row_range.hpp"

namespace rtg::stream {

/// What a consumer says to the sender of the rows.
struct Acknowledgement {
  std::int64_t cursor = 0;        // rows below it have been received
  std::int64_t credit = 0;        // rows accepted beyond the cursor; 0: has the whole sealed stream
  std::vector<RowRange> missing;  // to be sent again

  bool operator==(const Acknowledgement&) const = default;
};

/// The receiving end of the transition stream, which gets every row once and in order from a
/// network that loses, doubles and reorders. The class does no I/O: the caller passes in received
/// messages and the time, and sends the acknowledgements that due() returns. It holds at most
/// `credit` rows beyond the cursor. `Rows`: the rows of one message.
template <class Rows>
class StreamCursor {
 public:
  /// Times in seconds.
  struct Limits {
    std::int64_t credit = 8192;
    bus::Seconds interval = 0.5;         // between acknowledgements without progress
    bus::Seconds retry = 0.1;            // between two requests for the same rows
    bus::Seconds least_interval = 0.01;  // between any two acknowledgements
    std::size_t most_ranges = 32;        // in one acknowledgement
    // Acknowledgements at once when the stream is complete. The consumer may then end, so one of
    // them has to survive the network.
    int farewells = 10;
  };
  /// The rows of a message, of which the first `skip` are known.
  using Piece = std::pair<Rows, std::int64_t>;

  explicit StreamCursor(const Limits& limits = {}) : limits_(limits) {}

  /// Takes the rows `range`. Returns the pieces that are next in order. Ignores rows beyond the
  /// credit.
  std::vector<Piece> on_rows(RowRange range, Rows rows, bus::Seconds now) {
    arrived_ = now;
    count_ = std::max(count_, range.end);
    if (range.end <= cursor_ || range.end > cursor_ + limits_.credit) return {};
    const auto held = ahead_.find(range.begin);
    if (held == ahead_.end() || held->second.first < range.end)
      ahead_.insert_or_assign(range.begin, std::pair(range.end, std::move(rows)));
    return in_order();
  }

  /// Takes what the sender says of the stream: `count` rows exist; `sealed`: there will be no more.
  void on_tail(std::int64_t count, bool sealed) {
    count_ = std::max(count_, count);
    sealed_ = sealed_ || sealed;
  }

  /// Returns the next acknowledgement to send, if any. To be called until it returns nothing.
  std::optional<Acknowledgement> due(bus::Seconds now) {
    if (complete()) return farewell(now);
    std::vector<RowRange> missing = this->missing();
    bool request = !missing.empty() && (cursor_ >= requested_end_ ||  // all of those have arrived
                                        now - requested_ >= limits_.retry);
    // If no later row has arrived, the missing rows are probably still on their way.
    if (ahead_.empty() && now - arrived_ < limits_.retry / 2.0) request = false;
    const bool moved = cursor_ - said_cursor_ >= limits_.credit / 4;
    const bool idle = now - said_ >= limits_.interval;
    if (!(request || moved || idle) || now - said_ < limits_.least_interval) return std::nullopt;
    said_ = now;
    said_cursor_ = cursor_;
    if (!request) return Acknowledgement{cursor_, limits_.credit, {}};
    requested_ = now;
    requested_end_ = missing.back().end;
    return Acknowledgement{cursor_, limits_.credit, std::move(missing)};
  }

  std::int64_t cursor() const { return cursor_; }  // number of the next row in order
  /// Returns whether the number of rows is final and every row has been returned.
  bool complete() const { return sealed_ && cursor_ == count_; }

 private:
  static constexpr bus::Seconds kNever = -1e9;

  std::vector<Piece> in_order() {
    std::vector<Piece> pieces;
    while (!ahead_.empty() && ahead_.begin()->first <= cursor_) {
      auto node = ahead_.extract(ahead_.begin());
      auto& [end, rows] = node.mapped();
      if (end <= cursor_) continue;
      pieces.emplace_back(std::move(rows), cursor_ - node.key());
      cursor_ = end;
    }
    return pieces;
  }

  /// Returns the missing rows within the credit, at most `most_ranges` ranges.
  std::vector<RowRange> missing() const {
    std::vector<RowRange> gaps;
    std::int64_t at = cursor_;
    for (const auto& [begin, held] : ahead_) {
      if (begin > at) gaps.push_back({at, begin});
      at = std::max(at, held.first);
    }
    const std::int64_t end = std::min(count_, cursor_ + limits_.credit);
    if (at < end) gaps.push_back({at, end});
    if (gaps.size() > limits_.most_ranges) gaps.resize(limits_.most_ranges);
    return gaps;
  }

  std::optional<Acknowledgement> farewell(bus::Seconds now) {
    if (farewells_ < limits_.farewells)
      ++farewells_;
    else if (now - said_ < limits_.interval)
      return std::nullopt;
    said_ = now;
    return Acknowledgement{cursor_, 0, {}};
  }

  Limits limits_;
  std::int64_t cursor_ = 0, count_ = 0;
  bool sealed_ = false;
  std::map<std::int64_t, std::pair<std::int64_t, Rows>> ahead_;  // by first row; may overlap
  bus::Seconds said_ = kNever, requested_ = kNever, arrived_ = kNever;
  std::int64_t said_cursor_ = 0, requested_end_ = 0;
  int farewells_ = 0;
};

}  // namespace rtg::stream

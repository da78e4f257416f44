#include "nodes/stream/stream_server.hpp"

#include <algorithm>

namespace rtg::stream {

StreamServer::StreamServer(const Limits& limits, std::int64_t row_bytes)
    : limits_(limits),
      rows_per_message_(std::max<std::int64_t>(1, limits.chunk_bytes / row_bytes)),
      row_bytes_(static_cast<double>(row_bytes)),
      tokens_(limits.burst) {}

void StreamServer::append(std::span<const search::Transition> rows) {
  rows_.insert(rows_.end(), rows.begin(), rows.end());
}

bool StreamServer::on_ack(const Ack& ack, bus::Seconds now) {
  if (ack.cursor < 0 || ack.cursor > count() || ack.credit < 0 || ack.credit > limits_.max_credit ||
      (consumers_.size() >= limits_.max_consumers && !consumers_.contains(ack.consumer)))
    return false;
  Consumer& consumer = consumers_[ack.consumer];
  consumer.cursor = std::max(consumer.cursor, ack.cursor);  // an old acknowledgement may come late
  consumer.credit = ack.credit;
  consumer.heard = now;
  consumer.complete = consumer.complete || (sealed_ && ack.cursor == count() && ack.credit == 0);
  std::int64_t budget = limits_.max_nacked;
  for (const RowRange& range : ack.missing) {
    const std::int64_t begin = std::clamp<std::int64_t>(range.begin, 0, first_unsent_);
    const RowRange known{begin, std::min({range.end, first_unsent_, begin + budget})};
    if (known.begin >= known.end) continue;
    budget -= known.end - known.begin;
    ask(known);
  }
  return true;
}

std::vector<RowRange> StreamServer::due(bus::Seconds now) {
  tokens_ = std::min(limits_.burst, tokens_ + limits_.rate * std::max(0.0, now - refilled_));
  refilled_ = now;
  std::vector<RowRange> sends;
  while (tokens_ > 0.0) {
    const RowRange range = next(now);
    if (range.begin == range.end) break;
    tokens_ -= row_bytes_ * static_cast<double>(range.end - range.begin);
    sends.push_back(range);
  }
  return sends;
}

std::span<const search::Transition> StreamServer::rows(RowRange range) const {
  return std::span(rows_).subspan(static_cast<std::size_t>(range.begin),
                                  static_cast<std::size_t>(range.end - range.begin));
}

std::int64_t StreamServer::slowest_cursor() const {
  std::int64_t cursor = consumers_.empty() ? 0 : count();
  for (const auto& [id, consumer] : consumers_) cursor = std::min(cursor, consumer.cursor);
  return cursor;
}

bool StreamServer::drained(int consumers, bus::Seconds now) const {
  int complete = 0;
  for (const auto& [id, consumer] : consumers_) {
    if (consumer.complete)
      ++complete;
    else if (now - consumer.heard <= limits_.silence)
      return false;
  }
  return sealed_ && first_unsent_ == count() && complete >= consumers;
}

/// Adds `range` to the requested ranges and merges it with those that it overlaps or touches. So
/// rows that are requested twice before they are sent are sent once.
void StreamServer::ask(RowRange range) {
  auto it = requested_.upper_bound(range.begin);
  if (it != requested_.begin() && std::prev(it)->second >= range.begin) --it;
  while (it != requested_.end() && it->first <= range.end) {
    range = {std::min(range.begin, it->first), std::max(range.end, it->second)};
    it = requested_.erase(it);
  }
  requested_[range.begin] = range.end;
}

/// Returns the rows of the next message; rows requested again come first. Returns an empty range if
/// there is nothing to send.
RowRange StreamServer::next(bus::Seconds now) {
  if (!requested_.empty()) {
    const auto [begin, end] = *requested_.begin();
    const RowRange range{begin, std::min(end, begin + rows_per_message_)};
    requested_.erase(requested_.begin());
    if (range.end < end) requested_[range.end] = end;
    resent_ += range.end - range.begin;
    return range;
  }
  const RowRange range{
      first_unsent_, std::clamp(live_limit(now), first_unsent_, first_unsent_ + rows_per_message_)};
  first_unsent_ = range.end;
  return range;
}

/// Returns the first row that may not be sent yet, by the credit of the living consumers.
std::int64_t StreamServer::live_limit(bus::Seconds now) const {
  std::int64_t limit = count();
  for (const auto& [id, consumer] : consumers_)
    if (now - consumer.heard <= limits_.silence)
      limit = std::min(limit, consumer.cursor + consumer.credit);
  return limit;
}

}  // namespace rtg::stream

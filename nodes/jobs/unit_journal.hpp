#pragma once

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "nodes/bus/wire.hpp"
#include "nodes/jobs/job_dispatcher.hpp"
#include "nodes/jobs/services.hpp"
#include "nodes/journal/journal.hpp"

namespace rtg::jobs {

/// The answers to the units of a generation, in a file. A search that begins anew takes them from
/// there and so comes soon to where an earlier one was killed. A record is the result message of a
/// unit; that of a unit that was given up has no bytes. Several threads may use it.
class UnitJournal {
 public:
  /// Opens the file as Journal does. `generation` identifies the generation: units of equal names
  /// have equal answers. Throws journal::JournalError.
  UnitJournal(const std::filesystem::path& file, std::int64_t generation)
      : generation_(generation), journal_(file, generation) {}

  std::int64_t generation() const { return generation_; }

  /// Returns the results of unit `id`, which has `jobs` jobs: none of them if the unit was given
  /// up. Returns nothing if the journal has no legal answer.
  template <class Service>
  std::optional<std::vector<typename Service::Result>> find(JobId id, std::size_t jobs,
                                                            const TaskShape& shape) {
    const std::scoped_lock lock(mutex_);
    const auto bytes = journal_.find(id);
    if (!bytes) return std::nullopt;
    std::optional<std::vector<typename Service::Result>> results(std::in_place);
    if (!bytes->empty()) {
      typename Service::ResultMessage message{};
      if (bus::decode(*bytes, message)) return std::nullopt;
      results = Service::parse(message, shape);
      if (!results || results->size() != jobs) return std::nullopt;
    }
    ++units_found_;
    for (const auto& result : *results) cpu_s_found_ += result.cpu_s;
    return results;
  }

  /// Adds the answer to unit `id`. Throws journal::JournalError.
  template <class Message>
  void add(JobId id, Message message) {
    append(id, bus::encode(message));
  }
  void add_given_up(JobId id) { append(id, {}); }

  std::size_t size() const {
    const std::scoped_lock lock(mutex_);
    return journal_.size();
  }
  std::int64_t dropped_bytes() const { return journal_.dropped_bytes(); }
  /// Return the number of units that find() has answered, and the CPU time of their results [s].
  long units_found() const {
    const std::scoped_lock lock(mutex_);
    return units_found_;
  }
  double cpu_s_found() const {
    const std::scoped_lock lock(mutex_);
    return cpu_s_found_;
  }

 private:
  void append(JobId id, std::span<const std::uint8_t> bytes) {
    const std::scoped_lock lock(mutex_);
    journal_.append(id, bytes);
  }

  std::int64_t generation_;
  mutable std::mutex mutex_;  // guards the members below
  journal::Journal journal_;
  long units_found_ = 0;
  double cpu_s_found_ = 0.0;
};

}  // namespace rtg::jobs

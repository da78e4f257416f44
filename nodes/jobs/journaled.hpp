#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

#include "nodes/bus/clock.hpp"
#include "nodes/jobs/unit_journal.hpp"
#include "nodes/jobs/unit_table.hpp"

namespace rtg::jobs {

/// The number of units whose answers are computed before they are added to a journal: those of
/// about a second, but never so few that threads would wait for each other.
class Piece {
 public:
  static constexpr std::size_t kLeast = 16;

  std::size_t units() const { return units_; }

  /// Tells how long a piece of `units` took. One that is not full says nothing of longer ones.
  void took(std::size_t units, bus::Seconds seconds) {
    if (seconds < 0.5 && units >= units_) units_ *= 2;
    if (seconds > 2.0) units_ = std::max(kLeast, units_ / 2);
  }

 private:
  std::size_t units_ = kLeast;
};

/// Returns `batch`, a SolveBatch or ReplayBatch, with a journal: it is asked for those units alone
/// that the journal does not answer, piece by piece, and the answers of each piece are added to the
/// journal before the next. A unit that was given up is computed. `journal` must outlive the
/// result, which one thread at a time may call.
template <class Service, class Batch>
Batch journaled(Batch batch, UnitJournal& journal, const TaskShape& shape) {
  using Job = typename Service::Job;
  return [batch = std::move(batch), &journal, shape, units = UnitTable<Service>(),
          piece = Piece()](std::span<const Job> jobs) mutable {
    std::vector<JobId> open;
    for (const JobId id : units.deal(jobs, shape, journal.generation())) {
      const std::span<const Job> unit = units.jobs(id);
      const auto known = journal.find<Service>(id, unit.size(), shape);
      if (known && !known->empty())
        units.store(id, *known);
      else
        open.push_back(id);
    }
    auto left = std::span(open);
    do {
      const auto some = left.first(std::min(left.size(), piece.units()));
      left = left.subspan(some.size());
      std::vector<Job> unanswered;
      for (const JobId id : some) std::ranges::copy(units.jobs(id), std::back_inserter(unanswered));
      const bus::Seconds begin = bus::monotonic_now();
      const auto answers = batch(unanswered);
      piece.took(some.size(), bus::monotonic_now() - begin);
      auto rest = std::span(answers);
      for (const JobId id : some) {
        const auto results = rest.first(units.jobs(id).size());
        journal.add(id, Service::message(results));
        units.store(id, results);
        rest = rest.subspan(results.size());
      }
    } while (!left.empty());
    return units.take();
  };
}

/// Puts `journal` before both `solve` and `replay`.
inline void keep_in(UnitJournal& journal, const TaskShape& shape, search::GenerationSeams& seams) {
  seams.solve = journaled<ReverseService>(std::move(seams.solve), journal, shape);
  seams.replay = journaled<ReplayService>(std::move(seams.replay), journal, shape);
}

}  // namespace rtg::jobs

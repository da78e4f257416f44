#pragma once

#include <span>
#include <utility>
#include <vector>

#include "nodes/jobs/unit_journal.hpp"
#include "nodes/jobs/unit_table.hpp"

namespace rtg::jobs {

/// Returns `batch`, a SolveBatch or ReplayBatch, with a journal: it is asked for those units alone
/// that the journal does not answer, and its answers are added to the journal. A unit that was
/// given up is computed. `journal` must outlive the result, which one thread at a time may call.
template <class Service, class Batch>
Batch journaled(Batch batch, UnitJournal& journal, const TaskShape& shape) {
  using Job = typename Service::Job;
  return [batch = std::move(batch), &journal, shape,
          units = UnitTable<Service>()](std::span<const Job> jobs) mutable {
    std::vector<JobId> open;
    std::vector<Job> unanswered;
    for (const JobId id : units.deal(jobs, shape, journal.generation())) {
      const std::span<const Job> unit = units.jobs(id);
      const auto known = journal.find<Service>(id, unit.size(), shape);
      if (known && !known->empty()) {
        units.store(id, *known);
      } else {
        open.push_back(id);
        unanswered.insert(unanswered.end(), unit.begin(), unit.end());
      }
    }
    const auto answers = batch(unanswered);
    auto rest = std::span(answers);
    for (const JobId id : open) {
      const auto results = rest.first(units.jobs(id).size());
      journal.add(id, Service::message(results));
      units.store(id, results);
      rest = rest.subspan(results.size());
    }
    return units.take();
  };
}

/// Puts `journal` before both `solve` and `replay`.
inline void keep_in(UnitJournal& journal, const TaskShape& shape, search::GenerationSeams& seams) {
  seams.solve = journaled<ReverseService>(std::move(seams.solve), journal, shape);
  seams.replay = journaled<ReplayService>(std::move(seams.replay), journal, shape);
}

}  // namespace rtg::jobs

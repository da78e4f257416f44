#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "nodes/jobs/job_dispatcher.hpp"
#include "nodes/jobs/services.hpp"

namespace rtg::jobs {

/// Splits a batch of jobs into units, one message each, and collects the results in job order.
/// Refers to the caller's jobs, which must outlive the use of the table.
template <class Service>
class UnitTable {
 public:
  using Job = typename Service::Job;
  using Result = typename Service::Result;

  /// Splits `jobs` into units and returns their ids in order. Equal units have equal ids. Drops the
  /// units of the previous batch.
  std::vector<JobId> deal(std::span<const Job> jobs, const TaskShape& shape, std::int64_t config) {
    units_.clear();
    results_.assign(jobs.size(), {});
    std::vector<JobId> ids;
    std::size_t first = 0;
    for (const std::size_t size : unit_sizes(jobs.size(), Service::kUnit, shape)) {
      const Unit unit{first, jobs.subspan(first, size)};
      ids.push_back(unit_id(unit.jobs, config));
      units_.emplace(ids.back(), unit);
      first += size;
    }
    return ids;
  }

  bool contains(JobId id) const { return units_.contains(id); }

  /// Returns the jobs of unit `id`. The table must contain it.
  std::span<const Job> jobs(JobId id) const { return units_.find(id)->second.jobs; }

  /// Stores the results of unit `id`, one per job, for all units with that id.
  void store(JobId id, std::span<const Result> results) {
    const auto [begin, end] = units_.equal_range(id);
    for (auto it = begin; it != end; ++it)
      std::copy(results.begin(), results.end(),
                results_.begin() + static_cast<std::ptrdiff_t>(it->second.first));
  }

  /// Returns the results in job order and empties the table.
  std::vector<Result> take() {
    units_.clear();
    return std::exchange(results_, {});
  }

 private:
  struct Unit {
    std::size_t first;  // index of its first job
    std::span<const Job> jobs;
  };

  std::unordered_multimap<JobId, Unit> units_;
  std::vector<Result> results_;
};

}  // namespace rtg::jobs

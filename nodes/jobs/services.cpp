#include "nodes/jobs/services.hpp"

#include <algorithm>
#include <utility>

#include "core/math/hash.hpp"
#include "nodes/bus/wire.hpp"
#include "nodes/jobs/flat_poses.hpp"
#include "nodes/jobs/solutions.hpp"

namespace rtg::jobs {
namespace {

constexpr std::size_t kEnvelope = 200;  // upper bound of a message without its arrays [bytes]
constexpr std::size_t kPerJob = 16;     // upper bound of a job or result without its poses [bytes]

template <class Message>
bool has_shape(const Message& message, const TaskShape& shape) {
  return message.n >= 1 && message.n_poses == std::int64_t{3} * message.n * shape.bodies;
}

/// Returns whether the counts of `message` are consistent. A solve with predecessors must have 1 to
/// kMaxPredecessors of them, any other solve none. n_poses must match the sum of `starts`.
bool has_consistent_starts(const rtg_msgs::reverse_result_t& message, const TaskShape& shape) {
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < message.starts.size(); ++i) {
    const bool some =
        reverse::has_predecessors(static_cast<reverse::SolveStatus>(message.status[i]));
    if (message.starts[i] < (some ? 1 : 0) ||
        message.starts[i] > (some ? reverse::kMaxPredecessors : 0))
      return false;
    sum += message.starts[i];
  }
  return message.n >= 1 && message.n_poses == 3 * sum * shape.bodies;
}

bool all_between(const auto& values, auto least, auto most) {
  return std::all_of(values.begin(), values.end(), [=](auto v) { return v >= least && v <= most; });
}

template <class Message>
void set_counts(Message& message, std::size_t n, const std::vector<double>& poses) {
  message.n = static_cast<std::int32_t>(n);
  message.n_poses = static_cast<std::int32_t>(poses.size());
}

std::uint64_t unit_key(const reverse::ReverseJob& job) {
  return hashed(reverse::key_of(job), job.with_solution ? 1 : 0);
}
std::uint64_t unit_key(const search::ReplayJob& job) {
  return reverse::key_of(job.start, job.action);
}

template <class Job>
std::int64_t hash_of(std::span<const Job> jobs, std::int64_t config) {
  auto hash = static_cast<std::uint64_t>(config);
  for (const Job& job : jobs) hash = hashed(hash, unit_key(job));
  return static_cast<std::int64_t>(hash);
}

}  // namespace

ReverseService::JobMessage ReverseService::message(std::span<const Job> jobs) {
  JobMessage out{};
  for (const Job& job : jobs) {
    append_poses(job.end, out.end);
    out.action.push_back(job.action);
    out.with_solution.push_back(job.with_solution ? 1 : 0);
  }
  set_counts(out, jobs.size(), out.end);
  return out;
}

ReverseService::ResultMessage ReverseService::message(std::span<const Result> results) {
  ResultMessage out{};
  for (const Result& r : results) {
    out.status.push_back(static_cast<std::int8_t>(r.status));
    out.iterations.push_back(r.iterations);
    out.cpu_s.push_back(r.cpu_s);
    out.starts.push_back(static_cast<std::int8_t>(r.predecessors.size()));
    for (const Poses& start : r.predecessors) append_poses(start, out.start);
  }
  set_counts(out, results.size(), out.start);
  write_solutions(results, out);
  return out;
}

std::optional<std::vector<reverse::ReverseJob>> ReverseService::parse(const JobMessage& message,
                                                                      const TaskShape& shape) {
  if (!has_shape(message, shape) || !all_between(message.action, 0, shape.actions - 1) ||
      !all_between(message.with_solution, 0, 1))
    return std::nullopt;
  std::vector<Job> jobs;
  for (std::size_t i = 0; i < message.action.size(); ++i)
    jobs.push_back(
        {poses_at(message.end, i, shape.bodies), message.action[i], message.with_solution[i] == 1});
  return jobs;
}

std::optional<std::vector<reverse::ReverseResult>> ReverseService::parse(
    const ResultMessage& message, const TaskShape& shape) {
  if (!all_between(message.status, 0, reverse::kSolveStatusCount - 1) ||
      !all_between(message.iterations, 0, 1000000000) || !all_between(message.cpu_s, 0.0, 1e9) ||
      !has_consistent_starts(message, shape))
    return std::nullopt;
  std::vector<Result> results;
  std::size_t at = 0;
  for (std::size_t i = 0; i < message.status.size(); ++i) {
    Result r{static_cast<reverse::SolveStatus>(message.status[i]),
             message.iterations[i],
             {},
             message.cpu_s[i]};
    for (int k = 0; k < message.starts[i]; ++k)
      r.predecessors.push_back(poses_at(message.start, at++, shape.bodies));
    results.push_back(std::move(r));
  }
  if (!read_solutions(message, shape.bodies, results)) return std::nullopt;
  return results;
}

reverse::ReverseResult ReverseService::given_up(const Job&) {
  return {reverse::SolveStatus::kNonFinite};
}

ReplayService::JobMessage ReplayService::message(std::span<const Job> jobs) {
  JobMessage out{};
  for (const Job& job : jobs) {
    append_poses(job.start, out.start);
    out.action.push_back(job.action);
  }
  set_counts(out, jobs.size(), out.start);
  return out;
}

ReplayService::ResultMessage ReplayService::message(std::span<const Result> results) {
  ResultMessage out{};
  for (const Result& r : results) {
    out.ok.push_back(r.ok ? 1 : 0);
    out.cpu_s.push_back(r.cpu_s);
    append_poses(r.end, out.end);
  }
  set_counts(out, results.size(), out.end);
  return out;
}

std::optional<std::vector<search::ReplayJob>> ReplayService::parse(const JobMessage& message,
                                                                   const TaskShape& shape) {
  static_assert(search::kSettle == -1);
  if (!has_shape(message, shape) ||
      !all_between(message.action, search::kSettle, shape.actions - 1))
    return std::nullopt;
  std::vector<Job> jobs;
  for (std::size_t i = 0; i < message.action.size(); ++i)
    jobs.push_back({poses_at(message.start, i, shape.bodies), message.action[i]});
  return jobs;
}

std::optional<std::vector<search::ReplayResult>> ReplayService::parse(const ResultMessage& message,
                                                                      const TaskShape& shape) {
  if (!has_shape(message, shape) || !all_between(message.ok, 0, 1) ||
      !all_between(message.cpu_s, 0.0, 1e9))
    return std::nullopt;
  std::vector<Result> results;
  for (std::size_t i = 0; i < message.ok.size(); ++i)
    results.push_back(
        {poses_at(message.end, i, shape.bodies), message.ok[i] == 1, message.cpu_s[i]});
  return results;
}

search::ReplayResult ReplayService::given_up(const Job& job) { return {job.start, false, 0.0}; }

std::vector<std::size_t> unit_sizes(std::size_t jobs, const UnitLimit& limit,
                                    const TaskShape& shape) {
  const std::size_t state = static_cast<std::size_t>(shape.bodies) * 3 * sizeof(double);
  const std::size_t per_job = limit.states * state + kPerJob;
  const std::size_t fits = (bus::kMaxMessageBytes - kEnvelope) / per_job;
  const std::size_t most = std::max<std::size_t>(1, std::min(limit.jobs, fits));
  const std::size_t units = (jobs + most - 1) / most;
  std::vector<std::size_t> sizes;
  for (std::size_t k = 0; k < units; ++k) sizes.push_back((jobs + k) / units);
  return sizes;
}

std::int64_t unit_id(std::span<const reverse::ReverseJob> jobs, std::int64_t config) {
  return hash_of(jobs, config);
}

std::int64_t unit_id(std::span<const search::ReplayJob> jobs, std::int64_t config) {
  return hash_of(jobs, config);
}

}  // namespace rtg::jobs

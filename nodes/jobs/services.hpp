#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <rtg_msgs/replay_job_t.hpp>
#include <rtg_msgs/replay_result_t.hpp>
#include <rtg_msgs/reverse_job_t.hpp>
#include <rtg_msgs/reverse_result_t.hpp>
#include <span>
#include <vector>

#include "core/search/seams.hpp"

namespace rtg::jobs {

/// The legal numbers in a task's messages.
struct TaskShape {
  int bodies = 0;
  int headings = 0;
};

/// The most that a unit, the load of one message, carries.
struct UnitLimit {
  std::size_t jobs;
  std::size_t states;  // in a job or its result
};

/// The two kinds of work that cross the bus: names, messages, and conversions between messages and
/// the core's types. A unit is what one message carries. A message that makes no sense for the task
/// (counts, range of actions, statuses) converts to nothing.
struct ReverseService {
  using Job = reverse::ReverseJob;
  using Result = reverse::ReverseResult;
  using JobMessage = rtg_msgs::reverse_job_t;
  using ResultMessage = rtg_msgs::reverse_result_t;
  static constexpr const char* kNode = "reverse_worker";
  static constexpr const char* kBeats = "RTG_REVERSE_BEAT";
  static constexpr const char* kJobs = "RTG_REVERSE_JOB";
  static constexpr const char* kResults = "RTG_REVERSE_RESULT";
  static constexpr UnitLimit kUnit{.jobs = 24, .states = reverse::kMaxStarts};

  static JobMessage message(std::span<const Job> jobs);
  static ResultMessage message(std::span<const Result> results);
  static std::optional<std::vector<Job>> parse(const JobMessage& message, const TaskShape& shape);
  static std::optional<std::vector<Result>> parse(const ResultMessage& message,
                                                  const TaskShape& shape);
  /// The result of a job that nobody survives.
  static Result given_up(const Job& job);
};

struct ReplayService {
  using Job = search::ReplayJob;
  using Result = search::ReplayResult;
  using JobMessage = rtg_msgs::replay_job_t;
  using ResultMessage = rtg_msgs::replay_result_t;
  static constexpr const char* kNode = "forward_sim_server";
  static constexpr const char* kBeats = "RTG_REPLAY_BEAT";
  static constexpr const char* kJobs = "RTG_REPLAY_JOB";
  static constexpr const char* kResults = "RTG_REPLAY_RESULT";
  static constexpr UnitLimit kUnit{.jobs = 24, .states = 1};

  static JobMessage message(std::span<const Job> jobs);
  static ResultMessage message(std::span<const Result> results);
  static std::optional<std::vector<Job>> parse(const JobMessage& message, const TaskShape& shape);
  static std::optional<std::vector<Result>> parse(const ResultMessage& message,
                                                  const TaskShape& shape);
  static Result given_up(const Job& job);
};

/// Sizes of the units that `jobs` jobs are dealt into: as few as fit into messages and `limit`
/// allows, and as equal as possible.
std::vector<std::size_t> unit_sizes(std::size_t jobs, const UnitLimit& limit,
                                    const TaskShape& shape);

/// Name of a unit: a hash of the configuration and of everything that is asked.
std::int64_t unit_id(std::span<const reverse::ReverseJob> jobs, std::int64_t config);
std::int64_t unit_id(std::span<const search::ReplayJob> jobs, std::int64_t config);

/// Appends x [m], y [m], θ [rad] of every body.
void append_poses(const Poses& poses, std::vector<double>& out);

}  // namespace rtg::jobs

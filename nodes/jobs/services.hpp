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

/// Numbers of bodies and actions of a task, for checks of messages.
struct TaskShape {
  int bodies = 0;
  int actions = 0;
};

/// Upper limits of a unit. A unit is the list of jobs that one message carries, milliseconds of
/// work: smaller ones cost more messages, larger ones keep workers waiting for the last.
struct UnitLimit {
  std::size_t jobs;
  std::size_t states;  // in one job or its result
};

/// ReverseService and ReplayService describe the two kinds of work that workers do. They hold the
/// channel names, the message types, and conversions between messages and types of core/. parse()
/// returns nothing for a message that is illegal for the task (counts, range of actions, statuses).
struct ReverseService {
  using Job = reverse::ReverseJob;
  using Result = reverse::ReverseResult;
  using JobMessage = rtg_msgs::reverse_job_t;
  using ResultMessage = rtg_msgs::reverse_result_t;
  static constexpr const char* kNode = "reverse_worker";
  static constexpr const char* kBeats = "RTG_REVERSE_BEAT";
  static constexpr const char* kJobs = "RTG_REVERSE_JOB";
  static constexpr const char* kResults = "RTG_REVERSE_RESULT";
  static constexpr UnitLimit kUnit{.jobs = 48, .states = reverse::kMaxPredecessors};

  static JobMessage message(std::span<const Job> jobs);
  static ResultMessage message(std::span<const Result> results);
  static std::optional<std::vector<Job>> parse(const JobMessage& message, const TaskShape& shape);
  static std::optional<std::vector<Result>> parse(const ResultMessage& message,
                                                  const TaskShape& shape);
  /// Returns the result used in place of the missing one of a job that was given up.
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
  static constexpr UnitLimit kUnit{.jobs = 128, .states = 1};

  static JobMessage message(std::span<const Job> jobs);
  static ResultMessage message(std::span<const Result> results);
  static std::optional<std::vector<Job>> parse(const JobMessage& message, const TaskShape& shape);
  static std::optional<std::vector<Result>> parse(const ResultMessage& message,
                                                  const TaskShape& shape);
  static Result given_up(const Job& job);
};

/// Splits `jobs` jobs into units and returns the number of jobs in each. There are as few units as
/// `limit` and the message size allow, of nearly equal size.
std::vector<std::size_t> unit_sizes(std::size_t jobs, const UnitLimit& limit,
                                    const TaskShape& shape);

/// Returns the id of the unit of `jobs`: a hash of `config` (the configuration's hash) and of all
/// states and actions.
std::int64_t unit_id(std::span<const reverse::ReverseJob> jobs, std::int64_t config);
std::int64_t unit_id(std::span<const search::ReplayJob> jobs, std::int64_t config);

}  // namespace rtg::jobs

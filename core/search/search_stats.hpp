#pragma once

#include <array>
#include <chrono>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

#include "core/search/seams.hpp"
#include "core/tasks/refusals.hpp"

namespace rtg::search {

/// Stages of a generation in which it waits for a batch of jobs. The rest of it is bookkeeping.
enum class Stage { kGoals, kSolves, kReplays, kBranches };
inline constexpr const char* kStages[] = {"goals", "solves", "replays", "branches"};
static_assert(std::size(kStages) == static_cast<std::size_t>(Stage::kBranches) + 1);

/// Time that the batches of a stage took [s]; CPU time of all threads and processes.
struct StageTime {
  double wall_s = 0.0, cpu_s = 0.0;
};

/// Counts of a run's reverse solves, its replays, and their failures. A candidate that the search
/// does not select is not a failure.
struct SearchStats {
  long candidates = 0;                                      // reverse jobs answered
  std::array<long, reverse::kSolveStatusCount> statuses{};  // of them, by SolveStatus
  std::vector<int> iterations;                              // of solves with predecessors
  std::vector<int> pushing_iterations;                      // of those that moved an object
  long illegal_starts = 0;             // solved starts that are no legal_state()
  long goal_draws = 0;                 // of goal states
  long undrawn_goals = 0;              // of them, those that failed
  tasks::Refusals goal_refusals = {};  // of the tries of all draws
  long unsettled_goals = 0;            // drawn goals that are no legal goal states once at rest
  long replays = 0;                    // requests to the simulator, kSettle included
  long rejected_pushes = 0;            // replays that the simulator could not finish
  std::vector<float> gaps;             // replay gaps of simulated reverse steps [m]
  std::array<StageTime, std::size(kStages)> times{};  // by Stage

  void count(const reverse::ReverseResult& answer, bool moved_object) {
    ++candidates;
    ++statuses[static_cast<std::size_t>(answer.status)];
    if (reverse::has_predecessors(answer.status)) {
      iterations.push_back(answer.iterations);
      if (moved_object) pushing_iterations.push_back(answer.iterations);
    }
  }

  void count(const ReplayResult& answer) {
    ++replays;
    rejected_pushes += !answer.ok;
  }
};

/// Returns a copy of `batch` that also adds its times to those of `stage`. `stats` must outlive it.
template <class Batch>
Batch timed(Batch batch, SearchStats& stats, Stage stage) {
  StageTime& time = stats.times[static_cast<std::size_t>(stage)];
  return [batch = std::move(batch), &time](auto jobs) {
    const auto begin = std::chrono::steady_clock::now();
    auto results = batch(jobs);
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
    time.wall_s += wall.count();
    for (const auto& result : results) time.cpu_s += result.cpu_s;
    return results;
  };
}

/// Returns a copy of `replay` that is timed() and counts its results in `stats`.
inline ReplayBatch counted(ReplayBatch replay, SearchStats& stats, Stage stage) {
  return
      [replay = timed(std::move(replay), stats, stage), &stats](std::span<const ReplayJob> jobs) {
        std::vector<ReplayResult> results = replay(jobs);
        for (const ReplayResult& result : results) stats.count(result);
        return results;
      };
}

}  // namespace rtg::search

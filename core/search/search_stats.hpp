#pragma once

#include <array>
#include <span>
#include <utility>
#include <vector>

#include "core/search/seams.hpp"

namespace rtg::search {

/// Counts of a run's reverse solves, its replays, and their failures. A candidate that the search
/// does not select is not a failure.
struct SearchStats {
  long candidates = 0;                                      // reverse jobs answered
  std::array<long, reverse::kSolveStatusCount> statuses{};  // of them, by SolveStatus
  std::vector<int> iterations;                              // of solves with predecessors
  std::vector<int> pushing_iterations;                      // of those that moved an object
  long illegal_starts = 0;   // solved starts that are no legal_state()
  long undrawn_goals = 0;    // failed draws of a goal state
  long unsettled_goals = 0;  // drawn goals that are no legal goal states once at rest
  long replays = 0;          // requests to the simulator, kSettle included
  long rejected_pushes = 0;  // replays that the simulator could not finish
  std::vector<float> gaps;   // replay gaps of replayed candidates [m]
  double reverse_cpu_s = 0.0, replay_cpu_s = 0.0;

  void count(const reverse::ReverseResult& answer, bool moved_object) {
    ++candidates;
    ++statuses[static_cast<std::size_t>(answer.status)];
    if (reverse::has_predecessors(answer.status)) {
      iterations.push_back(answer.iterations);
      if (moved_object) pushing_iterations.push_back(answer.iterations);
    }
    reverse_cpu_s += answer.cpu_s;
  }

  void count(const ReplayResult& answer) {
    ++replays;
    rejected_pushes += !answer.ok;
    replay_cpu_s += answer.cpu_s;
  }
};

/// Returns a copy of `replay` that also counts its results in `stats`. `stats` must outlive it.
inline ReplayBatch counted(ReplayBatch replay, SearchStats& stats) {
  return [replay = std::move(replay), &stats](std::span<const ReplayJob> jobs) {
    std::vector<ReplayResult> results = replay(jobs);
    for (const ReplayResult& result : results) stats.count(result);
    return results;
  };
}

}  // namespace rtg::search

#pragma once

#include <array>
#include <span>
#include <utility>
#include <vector>

#include "core/search/seams.hpp"

namespace rtg::search {

/// Counts of a run's reverse solves and replays, and of those that failed; what the search merely
/// chooses not to replay or to expand is not counted.
struct SearchStats {
  long candidates = 0;                                      // reverse jobs answered
  std::array<long, reverse::kSolveStatusCount> statuses{};  // of them, by SolveStatus
  std::vector<int> iterations;                              // of converged solves
  std::vector<int> pushing_iterations;                      // of those of them that moved an object
  long illegal_starts = 0;   // converged, yet the start overlaps or leaves the arena
  long undrawn_goals = 0;    // draws of a goal state in vain
  long unsettled_goals = 0;  // sampled goals that do not come to rest as legal goal states
  long replays = 0;          // pushes that the simulator was asked for
  long rejected_pushes = 0;  // replays that the simulator could not finish
  std::vector<float> gaps;   // of replayed candidates [m]
  double reverse_cpu_s = 0.0, replay_cpu_s = 0.0;

  void count(const reverse::ReverseResult& answer, bool moved_object) {
    ++candidates;
    ++statuses[static_cast<std::size_t>(answer.status)];
    if (answer.status == reverse::SolveStatus::kConverged) {
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

/// The same as `replay`, which it copies; `stats`, which must outlive it, counts all pushes.
inline ReplayBatch counted(ReplayBatch replay, SearchStats& stats) {
  return [replay = std::move(replay), &stats](std::span<const ReplayJob> jobs) {
    std::vector<ReplayResult> results = replay(jobs);
    for (const ReplayResult& result : results) stats.count(result);
    return results;
  };
}

}  // namespace rtg::search

#pragma once

#include <vector>

#include "core/search/predecessor.hpp"
#include "core/search/seams.hpp"
#include "tests/support/gathering.hpp"

namespace rtg::testing {

inline constexpr double kDrag = 0.5;  // what a push takes its object along [m]

inline Poses moved(Poses poses, std::size_t body, const Vector2d& by) {
  poses[body].x += by.x();
  poses[body].y += by.y();
  return poses;
}

/// Gathering in a world without contact: a push takes the robot one stride along and drags an
/// object of its own, which can be reckoned backwards but for the rounding to float,
/// 1e-7 of 8 m.
struct DraggingWorld {
  tasks::Task task = gathering();
  std::vector<double> drags{kDrag};        // one predecessor each per solve of a push that drags
  double aside = 0.0;                      // how far off every third push sets the robot down [m]
  double over = 0.0;                       // how much farther than reckoned a push drags [m]
  std::vector<reverse::ReverseJob> asked;  // last
  std::vector<reverse::ReverseResult> answered;

  search::SolveBatch solve = [this](std::span<const reverse::ReverseJob> jobs) {
    asked.assign(jobs.begin(), jobs.end());
    answered.clear();
    for (const reverse::ReverseJob& job : jobs) answered.push_back(predecessors(job));
    return answered;
  };

  search::ReplayBatch replay = [this](std::span<const search::ReplayJob> jobs) {
    std::vector<search::ReplayResult> results;
    for (const search::ReplayJob& job : jobs) results.push_back({pushed(job), true, 0.0});
    return results;
  };

  DraggingWorld() = default;
  DraggingWorld(const DraggingWorld&) = delete;  // the seams refer to it
  DraggingWorld& operator=(const DraggingWorld&) = delete;

  /// Object that a push takes along; 0: none. Every second action is a free move.
  static std::size_t dragged(int action) {
    return action % 2 == 0 ? 0 : 1 + static_cast<std::size_t>(action / 2 % 3);
  }

  bool misses(int action) const { return aside > 0.0 && action % 3 == 0; }

  reverse::ReverseResult predecessors(const reverse::ReverseJob& job) const {
    const Vector2d d = direction(job.action, task.push);
    const Poses back = moved(job.end, 0, -longest_stride(task.push) * d);
    const std::size_t object = dragged(job.action);
    if (object == 0) return {reverse::SolveStatus::kConverged, 1, {back}};
    reverse::ReverseResult out{reverse::SolveStatus::kConverged, 1};
    for (const double drag : drags) out.predecessors.push_back(moved(back, object, -drag * d));
    return out;
  }

  Poses pushed(const search::ReplayJob& job) const {
    if (job.action == search::kSettle) return job.start;
    const Vector2d d = direction(job.action, task.push);
    Poses end = moved(job.start, 0, longest_stride(task.push) * d);
    if (const std::size_t object = dragged(job.action); object != 0)
      end = moved(end, object, (kDrag + over) * d);
    return to_single(misses(job.action) ? moved(end, 0, {0.0, aside}) : end);
  }
};

}  // namespace rtg::testing

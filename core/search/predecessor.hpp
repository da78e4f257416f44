#pragma once

#include <span>
#include <vector>

#include "core/search/seams.hpp"
#include "core/search/search_stats.hpp"
#include "core/search/transition.hpp"
#include "core/tasks/task.hpp"

namespace rtg::search {

/// A reverse step: pushing `action` in `start` should lead, and once replayed truly leads, to
/// `end`.
struct Predecessor {
  int parent = 0;  // index of the job that it answers
  int action = 0;
  Poses start;
  Poses end;
  int moved = 0;      // objects moved by the push, objects_moved()
  double gap = 0.0;   // replay gap [m]; 0 before the replay
  double miss = 0.0;  // the same of the body that is off most [m]
  double left = 0.0;  // start_distance() of `start`, filled in by the search
  int depth = 0;      // actions until success, filled in by the search
};

/// Displacement from which on an object counts as moved [m].
inline constexpr double kMoved = 0.05;

/// to_single() of every pose.
Poses float_rounded(const Poses& poses);

/// Mean over the bodies of the distance between their positions [m]: Fig. 16's replay gap.
double replay_gap(const Poses& reverse_end, const Poses& replayed_end);

/// Number of bodies, the robot left out, whose position differs by more than kMoved.
int objects_moved(const Poses& a, const Poses& b);

/// Says whether a state can be the start of a transition: finite, robot in the arena, no overlap.
bool legal_state(const tasks::Task& task, const Poses& poses);

/// The starts of converged answers that, rounded to float, are legal states; others are counted.
/// `end` is still the state that the job asked for. `jobs` and `answers` have equal length.
std::vector<Predecessor> proposals(const tasks::Task& task,
                                   std::span<const reverse::ReverseJob> jobs,
                                   std::span<const reverse::ReverseResult> answers,
                                   SearchStats& stats);

/// Replaces `end` by what the push truly leads to and fills in moved, gap and miss; those
/// whose push the simulator rejects are left out.
std::vector<Predecessor> replay_predecessors(std::vector<Predecessor> predecessors,
                                             const ReplayBatch& replay);

}  // namespace rtg::search

#pragma once

#include <span>
#include <vector>

#include "core/search/seams.hpp"
#include "core/search/search_stats.hpp"
#include "core/search/transition.hpp"
#include "core/tasks/task.hpp"

namespace rtg::search {

/// A reverse step: the push `action` in `start` should lead to `end`. After the replay, `end` is
/// the state to which the push truly leads.
struct Predecessor {
  int parent = 0;  // index of the job that it answers; in BeamSearch, of a node
  int action = 0;
  Poses start;
  Poses end;
  int moved = 0;      // objects moved by the push, objects_moved()
  double gap = 0.0;   // replay gap [m]; 0 before the replay
  double miss = 0.0;  // largest distance of a body from `end` in the replay [m]
  double left = 0.0;  // start_distance() of `start`, filled in by the search
  int depth = 0;      // actions until success, filled in by the search
};

/// Displacement above which an object counts as moved [m].
inline constexpr double kMoved = 0.05;

/// Returns to_single() of every pose.
Poses float_rounded(const Poses& poses);

/// Returns the mean over all bodies of the distance between their two positions [m], the replay gap
/// of Fig. 16.
double replay_gap(const Poses& reverse_end, const Poses& replayed_end);

/// Returns the number of bodies, without the robot, whose positions differ by more than kMoved.
int objects_moved(const Poses& a, const Poses& b);

/// Returns whether a state can be the start of a transition: it is finite, the robot is in the
/// arena, and no bodies overlap.
bool legal_state(const tasks::Task& task, const Poses& poses);

/// Returns a Predecessor for each start of a converged answer that is a legal state after rounding
/// to float; counts the others as stats.illegal_starts. `end` is the end state of the job. `jobs`
/// and `answers` have equal length.
std::vector<Predecessor> proposals(const tasks::Task& task,
                                   std::span<const reverse::ReverseJob> jobs,
                                   std::span<const reverse::ReverseResult> answers,
                                   SearchStats& stats);

/// Returns the predecessors with `end` replaced by the state to which the push truly leads and with
/// moved, gap and miss filled in. Predecessors whose push the simulator rejects are left out.
std::vector<Predecessor> replay_predecessors(std::vector<Predecessor> predecessors,
                                             const ReplayBatch& replay);

}  // namespace rtg::search

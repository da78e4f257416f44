#pragma once

#include <span>
#include <vector>

#include "core/search/seams.hpp"
#include "core/search/search_stats.hpp"
#include "core/search/transition.hpp"
#include "core/tasks/task.hpp"

namespace rtg::search {

/// A reverse step: by the push `action`, the state `start` should lead to the state `end`. Before
/// the replay in the simulator, `end` is the final state that the reverse solver was given;
/// afterwards it is the true outcome.
struct Predecessor {
  int parent = 0;  // index of the reverse job; in BeamSearch, of the node it leads to
  int action = 0;
  Poses start;
  Poses end;
  int moved = 0;                // number of objects that the push moves, objects_moved()
  double mean_error = 0.0;      // mean replay error over the bodies, replay_gap() [m]
  double max_error = 0.0;       // largest replay error of a body [m]
  double start_distance = 0.0;  // start_distance() of `start`, set by the search
  int depth = 0;                // actions until success, set by the search
};

/// Displacement above which an object counts as moved [m].
inline constexpr double kMoved = 0.05;

/// Returns the replay gap of Fig. 16: the distance between the two positions of a body, averaged
/// over all bodies [m].
double replay_gap(const Poses& reverse_end, const Poses& replayed_end);

/// Returns the number of bodies other than the robot whose positions differ by more than kMoved.
int objects_moved(const Poses& a, const Poses& b);

/// Returns whether `poses` can be the start of a transition. They must be finite, with the robot in
/// the arena and without overlaps.
bool legal_state(const tasks::Task& task, const Poses& poses);

/// Returns a Predecessor for each start in `answers`, rounded to float. answers[k] belongs to
/// jobs[k]; `end` is the end state of the job. Leaves out starts that are no legal_state() and
/// counts them as stats.illegal_starts.
std::vector<Predecessor> proposals(const tasks::Task& task,
                                   std::span<const reverse::ReverseJob> jobs,
                                   std::span<const reverse::ReverseResult> answers,
                                   SearchStats& stats);

/// Simulates the push of each predecessor. Sets `end` to the true outcome, and `moved`,
/// `mean_error` and `max_error` accordingly. Leaves out predecessors whose push the simulator
/// rejects.
std::vector<Predecessor> replay_predecessors(std::vector<Predecessor> predecessors,
                                             const ReplayBatch& replay);

}  // namespace rtg::search

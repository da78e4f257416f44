#pragma once

#include <vector>

#include "core/search/seams.hpp"
#include "core/search/search_stats.hpp"
#include "core/search/transition.hpp"
#include "core/tasks/task.hpp"

namespace rtg::search {

/// A reverse step: by the push `action`, the state `start` should lead to the state `wanted_end`.
struct Predecessor {
  int parent = 0;  // index of the search's node whose state is `wanted_end`
  int action = 0;
  Poses start;
  Poses wanted_end;             // the final state that the reverse solver was given
  double start_distance = 0.0;  // start_distance() of `start`, set by the search
  int depth = 0;                // actions until success, set by the search
};

/// Displacement above which a body counts as moved [m].
inline constexpr double kMoved = 0.05;

/// Returns whether the positions of a body in two states differ by more than kMoved.
bool has_moved(const Pose& before, const Pose& after);

/// Returns the replay gap of Fig. 16: the distance between the two positions of a body, averaged
/// over all bodies [m].
double replay_gap(const Poses& reverse_end, const Poses& replayed_end);

/// Returns the number of bodies other than the robot that has_moved() holds for.
int objects_moved(const Poses& a, const Poses& b);

/// Returns whether `poses` can be the start of a transition. They must be finite, with the robot in
/// the arena and without overlaps.
bool legal_state(const tasks::Task& task, const Poses& poses);

/// Returns a Predecessor of node `parent` for each start in `answer`, the result of `job`. Starts
/// are rounded to float. Leaves out those that are no legal_state() and counts them as
/// stats.illegal_starts.
std::vector<Predecessor> proposals(const tasks::Task& task, const reverse::ReverseJob& job,
                                   const reverse::ReverseResult& answer, int parent,
                                   SearchStats& stats);

}  // namespace rtg::search

#pragma once

#include "core/math/stage_system.hpp"
#include "core/reverse/problem/problem_lanes.hpp"

namespace rtg::reverse {

/// Returns the lanes in which α step moves no pose by more than 1 m or 0.5 rad.
template <class T>
Mask<T> bounded(const StageStep<T>& step, const T& alpha);

/// The fraction α of a Newton step, with the steps of the forces.
template <class T>
struct Move {
  const StageStep<T>& step;
  const PerContact<T>& forces;  // [h + 1][contacts]
  const T& alpha;
};

/// Sets `trial` to x + α step. The poses and multipliers of jointed bodies follow from the
/// coordinates. The poses of fixed bodies in `trial` stay as they are.
template <class T>
void make_trial(const energy::SceneModel<T>& scene, const Trajectory<T>& x, const Move<T>& move,
                Trajectory<T>& trial);

}  // namespace rtg::reverse

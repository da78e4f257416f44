#pragma once

#include "core/math/stage_system.hpp"
#include "core/reverse/problem/problem_lanes.hpp"

namespace rtg::reverse {

/// Returns the lanes in which no coordinate of `alpha` times `step` exceeds 1 m or 0.5 rad. With
/// joints, these are the reduced coordinates.
template <class T>
Mask<T> bounded(const StageStep<T>& step, const T& alpha);

/// A Newton step, with its force steps `forces`, scaled by `alpha`.
template <class T>
struct Move {
  const StageStep<T>& step;
  const PerContact<T>& forces;  // [h + 1][contacts]
  const T& alpha;
};

/// Sets `trial` to `x` plus the scaled step `move`. With joints, the step is one of the reduced
/// coordinates, from which all poses and multipliers follow. Poses of fixed bodies in `trial` stay
/// as they are.
template <class T>
void make_trial(const energy::SceneModel<T>& scene, const Trajectory<T>& x, const Move<T>& move,
                Trajectory<T>& trial);

}  // namespace rtg::reverse

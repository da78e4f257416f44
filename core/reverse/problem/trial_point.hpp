#pragma once

#include "core/math/stage_system.hpp"
#include "core/reverse/problem/problem_lanes.hpp"

namespace rtg::reverse {

/// Where no pose moves by more than 1 m or 0.5 rad in α step.
template <class T>
Mask<T> bounded(const StageStep<T>& step, const T& alpha);

/// A share of a Newton step.
template <class T>
struct Move {
  const StageStep<T>& step;
  const PerContact<T>& forces;  // [h + 1][contacts]
  const T& alpha;
};

/// trial ← x + α step; jointed bodies and their multipliers follow. Poses of fixed bodies are left
/// as they are in `trial`.
template <class T>
void make_trial(const energy::SceneModel<T>& scene, const Trajectory<T>& x, const Move<T>& move,
                Trajectory<T>& trial);

}  // namespace rtg::reverse

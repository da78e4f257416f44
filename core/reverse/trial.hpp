#pragma once

#include "core/math/stage_system.hpp"
#include "core/reverse/problem_lanes.hpp"

namespace rtg {

/// Where no pose moves by more than 1 m or 0.5 rad in α step.
template <class T>
Mask<T> bounded(const StageStep<T>& step, const T& alpha);

/// trial ← x + α step, forces by `force_step` [h + 1][contacts]. Poses of fixed bodies are left as
/// they are in `trial`.
template <class T>
void make_trial(const Trajectory<T>& x, const StageStep<T>& step, const PerContact<T>& force_step,
                const T& alpha, Trajectory<T>& trial);

}  // namespace rtg

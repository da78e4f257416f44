#pragma once

#include "core/world/scene.hpp"

namespace rtg::forward {

/// Returns the distance [m] that the robot can move straight towards `to`, without turning, before
/// it comes within 0.05 m of a body. Returns 0 if a body is that near already. The result is at
/// most the distance of `to`.
double free_path_length(const Scene& scene, const Poses& poses, const Pose& to);

}  // namespace rtg::forward

#pragma once

#include "core/world/scene.hpp"

namespace rtg::forward {

/// Returns the distance that the robot can move straight towards `to`, heading held, before it is
/// within 0.05 m of a body; at most the distance of `to` [m]. Returns 0 if a body is that near
/// already.
double clear_way(const Scene& scene, const Poses& poses, const Pose& to);

}  // namespace rtg::forward

#pragma once

#include "core/world/scene.hpp"

namespace rtg::forward {

/// How far the robot moves straight on to `to`, heading held, until a body is within 0.05 m of it,
/// at most the whole way [m]; 0 where one is there already.
double clear_way(const Scene& scene, const Poses& poses, const Pose& to);

}  // namespace rtg::forward

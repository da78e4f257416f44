#pragma once

#include <vector>

#include "core/world/scene.hpp"

namespace rtg {

/// Some of the bodies of a scene, in a chosen order, with their poses.
struct Selection {
  Scene scene;
  Poses poses;
};

/// Returns `bodies` of the scene in the given order, with their poses and the joints between them.
Selection select(const Scene& scene, const Poses& poses, const std::vector<int>& bodies);

/// Returns the indices of all bodies, movable ones before fixed ones, each group in ascending
/// order.
std::vector<int> movable_first(const Scene& scene);

/// Returns `poses` with the poses of `bodies` replaced by `part`.
Poses merged(Poses poses, const Poses& part, const std::vector<int>& bodies);

}  // namespace rtg

#pragma once

#include <vector>

#include "core/world/scene.hpp"

namespace rtg {

/// A sub-scene: some bodies of a scene, in a chosen order, with their poses.
struct Selection {
  Scene scene;
  Poses poses;
};

/// Returns the sub-scene of the bodies with the indices `bodies`, in this order. It keeps the
/// joints between these bodies.
Selection select(const Scene& scene, const Poses& poses, const std::vector<int>& bodies);

/// Returns the indices of all bodies: first the movable ones, then the fixed ones, each in
/// ascending order.
std::vector<int> movable_first(const Scene& scene);

/// Returns `poses` with the pose of body `bodies[n]` replaced by `part[n]`, for all n.
Poses merged(Poses poses, const Poses& part, const std::vector<int>& bodies);

}  // namespace rtg

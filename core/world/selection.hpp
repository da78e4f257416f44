#pragma once

#include <vector>

#include "core/world/scene.hpp"

namespace rtg {

/// Some of the bodies of a scene, in a chosen order, with their poses.
struct Selection {
  Scene scene;
  Poses poses;
};

/// With the joints between them.
Selection select(const Scene& scene, const Poses& poses, const std::vector<int>& bodies);

/// All bodies, movable ones before fixed ones, otherwise in order.
std::vector<int> movable_first(const Scene& scene);

/// `poses` with those of `bodies` replaced by `part`.
Poses merged(Poses poses, const Poses& part, const std::vector<int>& bodies);

}  // namespace rtg

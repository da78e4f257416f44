#include "core/world/selection.hpp"

#include <algorithm>
#include <numeric>

namespace rtg {

Selection select(const Scene& scene, const Poses& poses, const std::vector<int>& bodies) {
  Selection s;
  for (const int k : bodies) {
    s.scene.bodies.push_back(scene.bodies[static_cast<std::size_t>(k)]);
    s.poses.push_back(poses[static_cast<std::size_t>(k)]);
  }
  const auto place_of = [&bodies](int body) {
    return static_cast<int>(std::ranges::find(bodies, body) - bodies.begin());
  };
  const int count = static_cast<int>(bodies.size());
  for (Joint joint : scene.joints) {
    joint.parent = place_of(joint.parent);
    joint.child = place_of(joint.child);
    if (joint.parent < count && joint.child < count) s.scene.joints.push_back(joint);
  }
  return s;
}

std::vector<int> movable_first(const Scene& scene) {
  std::vector<int> bodies(scene.size());
  std::iota(bodies.begin(), bodies.end(), 0);
  std::stable_partition(bodies.begin(), bodies.end(), [&scene](int k) {
    return !scene.bodies[static_cast<std::size_t>(k)].fixed;
  });
  return bodies;
}

Poses merged(Poses poses, const Poses& part, const std::vector<int>& bodies) {
  for (std::size_t n = 0; n < bodies.size(); ++n)
    poses[static_cast<std::size_t>(bodies[n])] = part[n];
  return poses;
}

}  // namespace rtg

#include "core/world/pace.hpp"

#include <algorithm>

namespace rtg {
namespace {

constexpr double kUsed = 0.99;  // share of the largest force; tanh c does not reach 1

}  // namespace

std::vector<double> paces(const Scene& scene, const PhysicsConfig& physics) {
  const double robot = mass_of(scene.bodies[0]).mass;
  std::vector<double> out(scene.size(), 1.0);
  for (std::size_t i = 1; i < scene.size(); ++i)
    if (!scene.bodies[i].fixed && !has_joint(scene, i))
      out[i] = std::min(
          1.0, kUsed * physics.force_factor * robot / (robot + mass_of(scene.bodies[i]).mass));
  return out;
}

}  // namespace rtg

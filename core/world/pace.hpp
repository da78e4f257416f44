#pragma once

#include <vector>

#include "core/world/physics_config.hpp"
#include "core/world/scene.hpp"

namespace rtg {

/// Returns for each body the speed at which the robot pushes it with almost all of its force, as a
/// share of its speed without a load:
///
///   σ_i = min(1, 0.99 φ m₀ / (m₀ + m_i)),   φ: PhysicsConfig::force_factor,
///
/// as with linear damping the force of a quasi-static push is proportional to mass and speed. 1 for
/// the robot, for fixed bodies and for those with joints, of which it is not known how much moves.
std::vector<double> paces(const Scene& scene, const PhysicsConfig& physics);

}  // namespace rtg

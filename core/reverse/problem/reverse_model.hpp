#pragma once

#include "core/reverse/problem/reverse_config.hpp"
#include "core/world/physics_config.hpp"
#include "core/world/scene.hpp"

namespace rtg::reverse {

/// The scene of a reverse problem and its physics. They may differ from those of the forward
/// simulator, which replays what the reverse simulator finds.
struct ReverseModel {
  Scene scene;
  PhysicsConfig physics;
};

/// Returns `scene` and `physics` with the values that `config` puts in their place.
inline ReverseModel reverse_model(const Scene& scene, const PhysicsConfig& physics,
                                  const ReverseConfig& config) {
  ReverseModel model{scene, physics};
  if (config.plain_barrier > 0.0) {
    model.physics.plain_barrier = true;
    model.physics.barrier = config.plain_barrier;
  }
  if (config.sharpness > 0.0) model.physics.sharpness = config.sharpness;
  if (config.torque_factor > 0.0) model.physics.torque_factor = config.torque_factor;
  if (config.periodic_turns) model.physics.periodic_turns = true;
  if (!scene.bodies.empty()) model.scene.bodies[0].density *= config.robot_density;
  return model;
}

}  // namespace rtg::reverse

#pragma once

#include "core/energy/step_energy.hpp"
#include "core/math/rng.hpp"
#include "core/reverse/problem/warm_start.hpp"
#include "tests/support/gathering.hpp"

namespace rtg::testing {

/// Gathering's robot with two boxes in a row in front of it, the second one turned: after a push to
/// the right all three rest in contact, face to face and corner to face.
struct TouchingScene {
  tasks::Task task = gathering();
  PhysicsConfig physics;
  Scene scene{{task.scene.bodies[0], task.scene.bodies[1], task.scene.bodies[2]}};
  energy::StepEnergy energy{scene, physics, task.push};
  Poses poses{{0.0, 0.0, 0.0}, {1.46, 0.15, 0.05}, {2.95, 0.35, 0.6}};

  /// Must be called when the physics have changed.
  void update() { energy = energy::StepEnergy(scene, physics, task.push); }

  /// The reverse problem that ends in these poses.
  reverse::ReverseProblem problem(const reverse::ReverseConfig& config) const {
    return {energy,
            config,
            energy::stacked(poses),
            Vector2d::UnitX(),
            physics.sub_steps + physics.settling_steps(),
            physics.settling_steps()};
  }
};

/// The touching scene where bodies coast: k_D = 1.
struct CoastingScene : TouchingScene {
  CoastingScene() {
    physics.inertia = true;
    physics.damping = 1.0;
    physics.barrier /= 20.0;  // in units of k_D/Δt²
    update();
  }
};

/// Vector of numbers in ±size.
inline VectorXd noise(Eigen::Index n, double size, Rng& rng) {
  return VectorXd::NullaryExpr(n, [&] { return rng.uniform(-size, size); });
}

/// x with random multipliers, and everything else moved at random by ±size.
inline reverse::Iterate disturbed(reverse::Iterate x, double size, Rng& rng) {
  for (std::size_t k = 0; k < x.p.size(); ++k) {
    x.p[k] += noise(x.p[k].size(), size, rng);
    for (double& force : x.forces[k])
      if (force != 0.0) force += rng.uniform(-size, size);
    x.controls[k] += noise(3, size, rng);
    x.multipliers[k] = noise(x.multipliers[k].size(), 1.0, rng);
  }
  return x;
}

}  // namespace rtg::testing

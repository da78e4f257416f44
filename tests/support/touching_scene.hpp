#pragma once

#include "core/energy/step_energy.hpp"
#include "core/math/rng.hpp"
#include "core/reverse/problem/warm_start.hpp"
#include "core/world/separation.hpp"
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

/// The letter T, as large as Gathering's boxes: a bar 1.6 x 0.4 and a stem 0.4 x 1.2 below it.
inline Shape letter_t() {
  std::vector<Part> parts = placed({{box(1.6, 0.4)}}, 0.0, {0.0, 0.8});
  parts.push_back({box(0.4, 1.2)});
  return Shape(std::move(parts)).centred();
}

/// A disc as robot, then a T and a box with round corners, in a row in contact.
struct RoundScene : TouchingScene {
  RoundScene() {
    scene.bodies[0].shape = Shape(disc(0.8));
    scene.bodies[1].shape = letter_t();
    scene.bodies[2].shape = Shape(Part{box(0.8, 0.8), 0.2});
    update();
    poses = {{0.0, 0.0, 0.3}, {4.0, 0.3, 2.0}, {8.0, 0.6, 0.6}};
    for (std::size_t k = 1; k < poses.size(); ++k)
      for (double gap = 1.0; gap > 0.03; poses[k].x -= gap - 0.02)
        gap = separation(scene.bodies[k].shape, poses[k], scene.bodies[k - 1].shape, poses[k - 1]);
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

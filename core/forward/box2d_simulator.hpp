#pragma once

#include <string>

#include "core/forward/simulator.hpp"

namespace rtg::forward {

/// The true dynamics for replay and learning: Box2D 2.4 (Catto), single precision.
///
/// Each push runs in a new Box2D world, so no state passes from one push to the next. The world is
/// matched to the step energy Ψ: no gravity, no restitution, linear and angular damping k_D/Δt. A
/// Box2D step lasts Δt/box2d_steps.
///
/// The robot is a dynamic body. A servo drives it along its straight path and holds its angle. In
/// each Box2D step the servo applies the force and the torque that take the robot to the next point
/// of the path. They are bounded by
///
///   B_f = force_factor · F [N],   B_ω = torque_factor · F r₀ [N·m],
///   F = m₀ k_D/Δt · stride/(hΔt).
///
/// m₀ is the robot's mass, r₀ its bounding radius and F its own drag at push speed. In dynamic mode
/// (1 + 1/k_D) F replaces F, to accelerate the robot to push speed within a sub-step. If the
/// bounded force does not suffice, the robot stops before its target. Its speed is at most 1.5
/// times the push speed, so that it does not jump when an obstacle gives way.
///
/// Joints are Box2D's revolute joints. Box2D lets a loaded joint exceed its limits by its angular
/// slop. The limits given to Box2D are therefore tighter by this slop.
///
/// Poses of moved bodies are single-precision values, widened to double. A push from them starts
/// without rounding and reproduces its result exactly. A body that received no impulse keeps its
/// pose bit for bit.
///
/// The simulation starts where the robot's path first comes near a body. A push that meets no body
/// ends at its target.
class Box2dSimulator final : public Simulator {
 public:
  /// Returns the version that Box2D says it has, "2.4.0" of Debian's 2.4.1.
  static std::string library_version();

  /// All shapes of `scene` must be legal (polygon_defect() returns nothing), and bodies[0] movable.
  Box2dSimulator(Scene scene, PushConfig push, PhysicsConfig physics);

  /// See Simulator::push_along. `ok` is false in each of these cases:
  ///
  /// - `start` has the wrong size, or a pose that is not finite, beyond 1000 m or beyond 1e4 rad;
  /// - a pose was not finite after a step;
  /// - the bodies did not come to rest.
  [[nodiscard]] PushOutcome push_along(const Poses& start, const Stroke& stroke) const override;

  /// See Simulator::settle. Moves overlapping bodies apart until they rest in contact.
  [[nodiscard]] PushOutcome settle(const Poses& start) const override;

 private:
  bool plausible(const Poses& start) const;

  Scene scene_;
  PhysicsConfig physics_;
};

}  // namespace rtg::forward

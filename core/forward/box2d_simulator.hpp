#pragma once

#include "core/forward/simulator.hpp"

namespace rtg::forward {

/// The true dynamics for replay and learning: Box2D 2.4 (Catto), single precision.
///
/// Each push has a new Box2D world, so no state passes from one push to the next. The world is
/// matched to the step energy Ψ: no gravity, no restitution, linear and angular damping k_D/Δt; a
/// Box2D step lasts Δt/box2d_steps. The robot is a dynamic body that a servo drives. In each Box2D
/// step the servo applies the force and the torque that bring the robot to the next point of its
/// straight path with the heading held, bounded by B_f and B_ω,
///
///   B_f = force_factor · F [N],   B_ω = torque_factor · F r₀ [N·m],
///   F = m₀ k_D/Δt · stride/(hΔt),
///
/// with r₀ the robot's bounding radius and F its own drag at push speed. In dynamic mode
/// (1 + 1/k_D) F replaces F: it also accelerates the robot to push speed within a sub-step. If the
/// bounded force does not suffice, the robot stops before its target. The robot never moves faster
/// than 1.5 times the push speed, so that it does not jump when an obstacle gives way.
///
/// Joints are Box2D's revolute joints. Box2D lets a loaded joint exceed its limits by its angular
/// slop; the limits are tightened by as much.
///
/// Poses of bodies that moved are single-precision values widened to double, so that a push from
/// them starts without rounding and reproduces its result exactly. A body that received no impulse
/// keeps its pose bit for bit. The part of the robot's path before the first body near it is not
/// simulated; a push that meets no body ends at its target.
class Box2dSimulator final : public Simulator {
 public:
  /// All shapes of `scene` must be legal (polygon_defect() empty) and bodies[0] movable.
  Box2dSimulator(Scene scene, PushConfig push, PhysicsConfig physics);

  /// See Simulator::push. `ok` is false if `start` has the wrong size, a pose in `start` is not
  /// finite, beyond 1000 m or beyond 1e4 rad, a step was not finite, or the bodies did not come to
  /// rest.
  [[nodiscard]] PushOutcome push(const Poses& start, int action) const override;

  /// See Simulator::settle. Moves overlapping bodies apart until they rest in contact.
  [[nodiscard]] PushOutcome settle(const Poses& start) const override;

 private:
  bool plausible(const Poses& start) const;

  Scene scene_;
  PushConfig push_;
  PhysicsConfig physics_;
};

}  // namespace rtg::forward

#pragma once

#include "core/forward/simulator.hpp"

namespace rtg::forward {

/// The true dynamics for replay and learning: Box2D 2.4 (Catto), single precision.
///
/// Every push gets a world of its own, so nothing is carried from one to the next. The world is
/// matched to the step energy Ψ: no gravity, no restitution, linear and angular damping k_D/Δt, one
/// Box2D step lasts Δt/box2d_steps. The robot is a dynamic body on a servo: in each Box2D step the
/// force and the torque, bounded by B_f and B_ω, that bring it to the next point of its straight
/// path with the heading held;
///
///   B_f = force_factor · F [N],   B_ω = torque_factor · F r₀ [N·m],
///   F = m₀ k_D/Δt · stride/(hΔt), the robot's own drag at push speed; (1 + 1/k_D) F in dynamic
///   mode, what gains that speed within a sub-step,
///
/// with r₀ the robot's bounding radius. It stops short where that is not enough, and never moves
/// faster than 1.5 × the push speed, so nothing jumps when a blocked robot comes free.
///
/// Joints are Box2D's; their limits are drawn in by the angular slop that it allows a pressed
/// joint.
///
/// Poses of bodies that moved are single-precision values widened to double, hence a result is
/// reproduced exactly from its own start. A body that took no impulse keeps its pose bit for bit.
/// The way of the robot up to the first body near it is not simulated; a push that meets none ends
/// at its target.
class Box2dSimulator final : public Simulator {
 public:
  /// `scene`: legal shapes only (polygon_defect() empty), bodies[0] movable.
  Box2dSimulator(Scene scene, PushConfig push, PhysicsConfig physics);

  /// As Simulator::push. Not ok: `start` has the wrong size or a pose that is not finite or beyond
  /// 1000 m, or the bodies did not come to rest.
  [[nodiscard]] PushOutcome push(const Poses& start, int action) const override;

  /// As Simulator::settle; moves overlapping bodies apart until they rest in contact.
  [[nodiscard]] PushOutcome settle(const Poses& start) const override;

 private:
  bool plausible(const Poses& start) const;

  Scene scene_;
  PushConfig push_;
  PhysicsConfig physics_;
};

}  // namespace rtg::forward

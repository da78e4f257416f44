#pragma once

#include <cmath>

#include "core/math/elementary.hpp"

namespace rtg {

/// Least damping k_D in dynamic mode. Below it, bodies coast for about a hundred sub-steps or more.
inline constexpr double kLeastInertialDamping = 0.05;

/// Constants of the step energy Ψ and of the Box2D world matched to it.
struct PhysicsConfig {
  double time_step = 0.05;    // Δt of a sub-step [s]
  int sub_steps = 10;         // h, sub-steps of one push
  double damping = 20.0;      // k_D; Box2D gets linearDamping = angularDamping = k_D/Δt
  double barrier = 24.0;      // μ, weight of the contact barrier [J]
  double range = 0.15;        // ĝ, gap beyond which there is no contact force [m]
  double skin = 0.0;          // d₀, gap = distance - d₀ [m]; resting gaps follow from μ and ĝ
  double sharpness = 50.0;    // α of the log-sum-exp signed distance [1/m]
  double slip = 0.025;        // ε_u, displacement over which friction builds up [m]
  double force_factor = 6.0;  // B_f in units of the robot's own drag at push speed
  double torque_factor = 6.0;   // B_ω in units of that drag times the robot's radius
  bool plain_barrier = false;   // the paper's -μ log g, of infinite range
  bool inertia = false;         // dynamic mode: bodies keep their speed and coast after a push
  bool periodic_turns = false;  // the paper's 1 - cos Δθ in damping and inertia
  int box2d_steps = 5;          // Box2D steps per sub-step
  int box2d_velocity_iterations = 16;
  int box2d_position_iterations = 8;

  /// Returns the weight of inertia relative to damping: ι = 1/k_D in dynamic mode, else 0.
  double inertia_weight() const { return inertia ? 1.0 / damping : 0.0; }

  /// Returns the number of sub-steps for which the robot is held after a push, until bodies come to
  /// rest. Each divides the speed of a free body by 1 + k_D, all together by 100 or more. 0 without
  /// inertia.
  ///
  /// Departs from the paper: its states are two successive poses, so that a push may end while
  /// bodies move. Here it ends at rest, in poses alone, as the learner sees them.
  int settling_steps() const {
    return inertia ? static_cast<int>(std::ceil(logarithm(100.0) / logarithm(1.0 + damping))) : 0;
  }

  template <class Visitor>
  void visit(Visitor& v) {
    v.number("time_step", time_step, 1e-4, 10.0, "length of a sub-step [s]");
    v.integer("sub_steps", sub_steps, 1, 1024, "sub-steps of one push");
    v.number("damping", damping, 1e-6, 1e6, "damping coefficient k_D of the bodies, dimensionless");
    v.number("barrier", barrier, 1e-12, 1e6, "weight mu of the contact barrier [J]");
    v.number("range", range, 1e-4, 10.0, "gap beyond which contacts exert no force [m]");
    v.number("skin", skin, 0.0, 1.0,
             "gap = distance between bodies - skin [m]; must be below range");
    v.number("sharpness", sharpness, 1.0, 1e5,
             "sharpness of the smoothed signed distance (log-sum-exp) [1/m]");
    v.number("slip", slip, 1e-6, 10.0, "slip of a contact over which friction builds up [m]");
    v.number("force_factor", force_factor, 0.1, 1e6,
             "largest force on the robot / its own drag at push speed");
    v.number("torque_factor", torque_factor, 0.1, 1e6,
             "largest robot torque / (its drag at push speed x its radius)");
    v.flag("plain_barrier", plain_barrier,
           "use the barrier -mu log(gap), whose contact forces have infinite range");
    v.flag("inertia", inertia,
           "dynamic instead of quasi-static sub-steps; needs a damping of 0.05 or more");
    v.flag("periodic_turns", periodic_turns,
           "turns cost 1 - cos(turn) instead of turn^2 / 2 in damping and inertia");
    v.integer("box2d_steps", box2d_steps, 1, 1000, "Box2D steps per sub-step");
    v.integer("box2d_velocity_iterations", box2d_velocity_iterations, 1, 1000,
              "velocity iterations of Box2D's solver per Box2D step");
    v.integer("box2d_position_iterations", box2d_position_iterations, 1, 1000,
              "position iterations of Box2D's solver per Box2D step");
  }
};

}  // namespace rtg

#pragma once

#include <array>
#include <string_view>

#include "core/math/kkt_solver.hpp"
#include "core/reverse/problem/reverse_job.hpp"

namespace rtg::reverse {

enum class ReversePreset { kDefault, kPaper };
inline constexpr std::array<std::string_view, 2> kReversePresets{"default", "paper"};

/// Parameters of the reverse problem (eq. 6, 7) and its SQP (A.2). The default values are those of
/// the preset `default`. A loader begins with reverse_preset(preset) and overwrites the fields that
/// the user gives. Energies are in units of k_D/Δt², see core/NOTATION.md.
struct ReverseConfig {
  ReversePreset preset = ReversePreset::kDefault;
  KktMethod kkt = KktMethod::kBlockElimination;
  int max_iterations = 200;
  double feasibility_tol = 1e-6;   // ‖C‖∞
  double stationarity_tol = 1e-4;  // ‖∇L‖∞
  double robot_weight = 1.0;       // w₀ of eq. (6)
  double object_weight = 1.0;      // w_i, i > 0
  double control_weight = 1e-3;    // ε of eq. (6)
  double path_weight = 100.0;      // κ_x, action consistency; 0: the paper's objective
  double heading_weight = 100.0;   // κ_θ
  double speed_weight = 0.5;       // χ, limits the speed of objects to about the robot's
  double terminal_weight = 300.0;  // K of the spring to the final state; 0: the state is fixed, but
                                   // then not all rest states of Box2D have a predecessor
  double terminal_tolerance = 0.05;  // largest miss of the final state in a valid solution [m]
  double plain_barrier = 0.0;        // μ of the paper's -μ log g [J]; 0: the barrier of `physics`
  double sharpness = 0.0;            // α in the reverse problem [1/m]; 0: that of `physics`
  double torque_factor = 0.0;        // B_ω in the reverse problem; 0: that of `physics`
  double robot_density = 1.0;        // density of the robot in the reverse problem / its true one
  bool periodic_turns = false;       // the paper's 1 - cos Δθ, in the reverse problem alone
  double proximal_start = 1.0;       // δ of the first iteration
  int late_contacts = 7;             // further predecessors: the robot meets objects later

  template <class Visitor>
  void visit(Visitor& v) {
    v.choice("preset", preset, kReversePresets, "values of all fields that are not given");
    v.choice("kkt", kkt, kKktMethods, "how the Newton systems are solved");
    v.integer("max_iterations", max_iterations, 1, 100000, "SQP iterations per candidate");
    v.number("feasibility_tol", feasibility_tol, 1e-14, 1.0, "largest constraint violation");
    v.number("stationarity_tol", stationarity_tol, 1e-14, 1.0, "largest Lagrangian gradient");
    v.number("robot_weight", robot_weight, 0.0, 1e6, "pull of the robot against the push");
    v.number("object_weight", object_weight, 0.0, 1e6, "pull of the objects against the push");
    v.number("control_weight", control_weight, 1e-9, 1e6, "price of control");
    v.number("path_weight", path_weight, 0.0, 1e9, "holds the robot on the push's straight line");
    v.number("heading_weight", heading_weight, 0.0, 1e9, "holds the robot's heading");
    v.number("speed_weight", speed_weight, 0.0, 1e9, "price of objects that outrun the push");
    v.number("terminal_weight", terminal_weight, 0.0, 1e9, "holds the final state; 0: fixes it");
    v.number("terminal_tolerance", terminal_tolerance, 0.0, 100.0, "largest miss of it [m]");
    v.number("plain_barrier", plain_barrier, 0.0, 1e6, "weight of -mu log g; 0: physics' barrier");
    v.number("sharpness", sharpness, 0.0, 1e5, "of the reverse problem [1/m]; 0: that of physics");
    v.number("torque_factor", torque_factor, 0.0, 1e6,
             "of the reverse problem; 0: that of physics");
    v.number("robot_density", robot_density, 0.01, 100.0, "in the reverse problem / its true one");
    v.flag("periodic_turns", periodic_turns, "1 - cos instead of the square of turns");
    v.number("proximal_start", proximal_start, 1e-4, 1e9, "regularisation of the first step");
    v.integer("late_contacts", late_contacts, 0, kMaxPredecessors - 1,
              "predecessors whose objects are met later");
  }
};

/// Returns the configuration of `preset`. The preset `paper` is App. A and E as printed: objective,
/// l1 merit, QP with the Hessian of the objective only, static start, fixed final state, plain
/// barrier, periodic turns, cyclic reduction, 1000 iterations. What the paper leaves open is chosen
/// so that it drags objects: μ, ε, B_ω, α and the robot's mass.
inline ReverseConfig reverse_preset(ReversePreset preset) {
  ReverseConfig config;
  if (preset == ReversePreset::kDefault) return config;
  config.preset = ReversePreset::kPaper;
  config.kkt = KktMethod::kCyclicReduction;
  config.max_iterations = 1000;
  config.control_weight = 5.1;
  config.path_weight = config.heading_weight = 0.0;
  config.speed_weight = config.terminal_weight = 0.0;
  config.plain_barrier = 6.0;
  config.sharpness = 20.0;
  config.torque_factor = 1.0;
  config.robot_density = 8.0;
  config.periodic_turns = true;
  config.late_contacts = 0;
  return config;
}

}  // namespace rtg::reverse

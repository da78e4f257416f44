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
///
/// `preset` also chooses the solver, see solve_together(): the filter SQP from warm starts
/// (`default`), or the printed SQP with the l1 merit from the static start (`paper`).
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
    v.choice("preset", preset, kReversePresets,
             "values of keys not given, and SQP: filter, warm start (default) or l1 merit, static "
             "start (paper)");
    v.choice("kkt", kkt, kKktMethods, "solver of KKT systems");
    v.integer("max_iterations", max_iterations, 1, 100000,
              "largest number of SQP iterations per reverse problem");
    v.number("feasibility_tol", feasibility_tol, 1e-14, 1.0,
             "SQP tolerance: max norm of the constraint violation");
    v.number("stationarity_tol", stationarity_tol, 1e-14, 1.0,
             "SQP tolerance: max norm of the Lagrangian gradient");
    v.number("robot_weight", robot_weight, 0.0, 1e6,
             "weight that pulls the robot's start against the push [kg m]");
    v.number("object_weight", object_weight, 0.0, 1e6,
             "weight that pulls objects' starts against the push [kg m]");
    v.number("control_weight", control_weight, 1e-9, 1e6,
             "penalty on the squared robot controls [kg m^2]");
    v.number("path_weight", path_weight, 0.0, 1e9,
             "penalty on the robot leaving its straight path [kg]; 0: none");
    v.number("heading_weight", heading_weight, 0.0, 1e9,
             "penalty on the robot turning [kg m^2]; 0: none");
    v.number("speed_weight", speed_weight, 0.0, 1e9,
             "penalty on objects faster than the robot [kg m^2]; 0: none");
    v.number("terminal_weight", terminal_weight, 0.0, 1e9,
             "stiffness holding the final state [kg]; 0: it is fixed");
    v.number("terminal_tolerance", terminal_tolerance, 0.0, 100.0,
             "largest final position error of a valid solution [m]");
    v.number("plain_barrier", plain_barrier, 0.0, 1e6,
             "weight mu of a barrier -mu log(gap) [J]; 0: as in physics");
    v.number("sharpness", sharpness, 0.0, 1e5,
             "sharpness of the signed distance [1/m]; 0: as in physics");
    v.number("torque_factor", torque_factor, 0.0, 1e6,
             "largest robot torque / (drag x radius); 0: as in physics");
    v.number("robot_density", robot_density, 0.01, 100.0,
             "robot density in the reverse problem / its true density");
    v.flag("periodic_turns", periodic_turns,
           "turns cost 1 - cos(turn), not turn^2 / 2; false: as in physics");
    v.number("proximal_start", proximal_start, 1e-4, 1e9,
             "first proximal weight of the filter SQP [kg]");
    v.integer("late_contacts", late_contacts, 0, kMaxPredecessors - 1,
              "further predecessors per solution, in which contacts begin later");
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

#pragma once

#include <vector>

#include "core/energy/step_energy.hpp"
#include "core/reverse/problem/reverse_config.hpp"
#include "core/reverse/problem/solve_status.hpp"

namespace rtg::reverse {

/// The reverse problem of one candidate, eq. (6) and (7), over the sub-steps k = 1 ... h of a push:
///
///   min  Σ_i w_i (x_i, y_i)_0·d + ε Σ_k |c_k|² + Σ b(g(p_0)) + κ_x Σ_k |t₀ - t̄₀|²_k
///        + κ_θ Σ_k (θ₀ - θ̄₀)²_k + χ Σ_k Σ_{i>0} q³_{k,i} + K/2 |p_h - p̄|² [+ K/2 |p_{h-1} - p̄|²]
///   s.t. Φ_k = ∂Ψ/∂p₊(p_k, p_{k-1}, p_{k-2}, c_k) = 0,   λ_k g(p_k) = μ̃ w(g(p_k)),   g > 0,
///        at the start λ_0 (g(p_0) + g_s) = μ̃ w(g(p_0)), see Barrier::start_spare().
///
/// p̄ is the given final state. (t̄₀, θ̄₀)_k is the straight path of the robot that ends in p̄, at
/// `pace` times the speed of a push.
/// q_{k,i} is half the squared speed of object i, in units of the robot's speed (SpeedPenalty). The
/// term in brackets belongs to dynamic mode. In this mode bodies are at rest before the push,
/// p_{-1} = p_0. They also come to rest at its end, p_{h-1} = p_h, in `settling` sub-steps in which
/// the robot is held.
///
/// The preset `paper` has κ = 0 (PathPenalty), χ = 0 (SpeedPenalty), λ = μ̃/g (NewtonSystem,
/// Barrier) and p_h fixed (EndSpring).
struct ReverseProblem {
  const energy::StepEnergy& energy;
  const ReverseConfig& config;
  VectorXd end;        // p̄ [3·bodies]
  Vector2d direction;  // d(a)
  int sub_steps = 1;   // h
  int settling = 0;    // sub-steps at the end in which the robot is held
  double pace = 1.0;   // speed of the robot on its path / its speed without a load
};

/// An iterate of the SQP: a trajectory with its forces and multipliers. Entry k belongs to the end
/// of sub-step k, entry 0 to the start. controls[0] and multipliers[0] are unused.
struct Iterate {
  std::vector<VectorXd> p;            // p_k [3·bodies]
  std::vector<VectorXd> forces;       // λ_k [contacts]
  std::vector<Vector3d> controls;     // c_k
  std::vector<VectorXd> multipliers;  // of Φ_k = 0 [dofs]; with joints J y, see Articulation
};

/// Returns the iterate that stays in the final state in all sub-steps, with the forces of its gaps
/// and without controls.
Iterate static_iterate(const ReverseProblem& problem);

double objective(const ReverseProblem& problem, const Iterate& x);

/// Residuals of the constraints.
struct Violation {
  std::vector<VectorXd> residuals;        // Φ_k [dofs], entry 0 unused
  std::vector<VectorXd> complementarity;  // λ g - μ̃ w [contacts]
  double l1() const;
  double max() const;
};
Violation violation(const ReverseProblem& problem, const Iterate& x);

/// Returns the status of a converged iterate: kInfeasible if it misses the final state by more than
/// the tolerance, otherwise kConverged.
SolveStatus status_of_converged(const ReverseProblem& problem, const Iterate& x);

/// Returns the largest distance of a movable body at the end of `x` from its position in the given
/// final state [m].
double terminal_miss(const ReverseProblem& problem, const Iterate& x);

}  // namespace rtg::reverse

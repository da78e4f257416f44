#pragma once

#include <vector>

#include "core/math/kkt_solver.hpp"
#include "core/reverse/reverse_problem.hpp"

namespace rtg {

/// Direction in the space of iterates; entries as in Iterate.
struct Direction {
  std::vector<VectorXd> p;       // [dofs]
  std::vector<VectorXd> forces;  // [contacts]
  std::vector<Vector3d> controls;
  std::vector<VectorXd> multipliers;  // [dofs]
};

/// How the second derivatives are formed.
struct Curvature {
  bool exact = false;     // of the Lagrangian; else of the objective alone
  double proximal = 1.0;  // δ, added on poses and controls, 0.01 δ on forces
};

/// The Newton system of the first-order conditions at an iterate, eq. (9) and (10), with the
/// centred pairing: block k holds the pose after sub-step k, its control and the multiplier of Φ_k,
///
///   ζ_k = (Δp_k, Δc_k, y_k), k = 1 ... h;  ζ_0 = Δp_0,
///
/// or, where the final state is fixed and block h would have no pose, those of the next sub-step,
///
///   ζ_k = (Δp_k, Δc_{k+1}, y_{k+1}), k = 0 ... h-1.
///
/// Either way the matrix is block tridiagonal (Departs from the paper: its printed pairing is
/// pentadiagonal) and its last block regular: ∂Φ_k/∂p_k, or ∂Φ_{k+1}/∂p_k, is. Each force is
/// eliminated by its own complementarity row,
///
///   g Δλ + s ∇g·Δp = -(λ g - μ̃ w),  s = λ - μ̃ w'   =>   Δλ = a + b·Δp,
///
/// and the multiplier z of that row by stationarity in λ, z = -L_λ/g.
class Linearisation {
 public:
  Linearisation(const ReverseProblem& problem, const Iterate& x, const Curvature& curvature);

  const BlockTridiagonal& matrix() const { return K_; }
  const Violation& violation() const { return violation_; }

  /// ‖∇L‖∞ over poses and controls.
  double stationarity() const;
  /// Whether constraints and gradients are; the maxima of the norms overlook a NaN.
  bool finite() const;

  /// Right-hand side for constraint values `v`, those at the iterate or others. Its solution is the
  /// step and its multipliers' change.
  BlockVector right_hand_side(const Violation& v) const;

  /// The step that `solution` of the system with right_hand_side(v) stands for.
  Direction direction(const BlockVector& solution, const Violation& v) const;

  /// Derivative of the objective along a direction.
  double objective_slope(const Direction& d) const;
  /// Curvature of the model (proximal term included) along the primal part of a solution.
  double model_curvature(const BlockVector& solution) const;

 private:
  friend class LinearisationBuilder;

  /// A force eliminated from the system: Δλ = -c/g + b·Δp, with c its complementarity.
  struct Eliminated {
    int level = 0, contact = 0;
    double gap = 0.0;
    Vec6<double> b;         // ∂λ/∂p_k
    Vec6<double> normal;    // ∂Φ_k/∂λ
    Vec6<double> friction;  // ∂Φ_{k+1}/∂λ
    Vec6<double> now;       // ∂²L/∂λ∂p_k, with the proximal term
    Vec6<double> next;      // ∂²L/∂λ∂p_{k+1}
  };

  /// Where an unknown begins in the system.
  struct Place {
    int block = 0, row = 0;
  };
  bool has_pose(int level) const { return level < h_ || !problem_->fixed_end(); }
  Place pose_place(int level) const { return {level, 0}; }
  Place control_place(int step) const { return {problem_->fixed_end() ? step - 1 : step, n_}; }
  Place multiplier_place(int step) const { return {control_place(step).block, n_ + 3}; }

  const ReverseProblem* problem_;
  int h_, n_;
  Violation violation_;
  BlockTridiagonal K_;
  std::vector<Eliminated> eliminated_;
  std::vector<VectorXd> pose_gradient_;     // of the Lagrangian [dofs]
  std::vector<Vector3d> control_gradient_;  // of the Lagrangian
  std::vector<VectorXd> objective_pose_;    // gradients of the objective
  std::vector<Vector3d> objective_control_;
};

}  // namespace rtg

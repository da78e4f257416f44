#pragma once

#include "core/reverse/linearisation.hpp"

namespace rtg {

/// Assembles a Linearisation term by term.
class LinearisationBuilder {
 public:
  LinearisationBuilder(Linearisation& into, const Iterate& x, const Curvature& curvature);
  void run();

 private:
  void add_damping(int level);
  void add_control(int level);
  void add_objective();
  void add_speed(int k, int i);
  void add_start_barrier();
  void add_contact(int level, int contact);
  void add_normal_force(const Contact& c, const Gap<double>& g, Linearisation::Eliminated& e);
  void add_friction(const Contact& c, const LocalPoint<double>& here, Linearisation::Eliminated& e);
  void add_exact_normal(const Contact& c, Linearisation::Eliminated& e);
  void add_exact_friction(const Contact& c, Linearisation::Eliminated& e);
  void eliminate(const Contact& c, const Gap<double>& g, Linearisation::Eliminated& e);
  void add_proximal();

  // Where M [6×6] of a contact goes in K: Hessian of poses at a level, their coupling across
  // levels, ∂Φ_k/∂p_k, ∂Φ_{k+1}/∂p_k.
  void to_hessian(const Contact& c, const Mat6<double>& M, int level);
  void to_coupling(const Contact& c, const Mat6<double>& M, int level);
  void to_jacobian(const Contact& c, const Mat6<double>& M, int level);
  void to_jacobian_next(const Contact& c, const Mat6<double>& M, int level);

  /// The entry of K below (or on) the diagonal at row `row` + i, column `column` + j.
  double& entry(Linearisation::Place row, int i, Linearisation::Place column, int j);
  /// Adds M of a contact to K's blocks that begin at (row, column).
  void add(const Contact& c, const Mat6<double>& M, Linearisation::Place row,
           Linearisation::Place column);

  Linearisation& lin_;
  const ReverseProblem& problem_;
  const StepEnergy& energy_;
  const Iterate& x_;
  Curvature curvature_;
  int h_, n_;
  double force_gradient_ = 0.0;  // ∂L/∂λ of the contact at hand, complementarity aside
};

}  // namespace rtg

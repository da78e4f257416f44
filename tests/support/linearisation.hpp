#pragma once

#include <gtest/gtest.h>

#include "core/math/assembled_solver.hpp"
#include "core/reverse/problem/newton_system.hpp"

namespace rtg::testing {

/// Direction in the space of iterates; entries as in Iterate.
struct Direction {
  std::vector<VectorXd> p;       // [dofs]
  std::vector<VectorXd> forces;  // [contacts]
  std::vector<Vector3d> controls;
  std::vector<VectorXd> multipliers;  // [dofs]
};

/// reverse::Curvature of one candidate.
struct Curvature {
  bool lagrangian = false;
  double proximal = 1.0;
  bool start = lagrangian;
};

/// The NewtonSystem of one candidate as a matrix.
class Linearisation {
 public:
  Linearisation(const reverse::ReverseProblem& problem, const reverse::Iterate& x,
                const Curvature& curvature)
      : one_(problem),
        problem_(problem),
        x_(loaded(problem, x)),
        newton_(problem_),
        violation_(reverse::violation(problem, x)) {
    newton_.linearise(
        problem_, x_,
        {curvature.lagrangian ? 1.0 : 0.0, curvature.proximal, curvature.start ? 1.0 : 0.0});
  }

  const reverse::ReverseProblem& problem() const { return one_; }
  const reverse::NewtonSystem<double>& newton() const { return newton_; }
  const reverse::ProblemLanes<double>& lanes() const { return problem_; }
  const reverse::Trajectory<double>& trajectory() const { return x_; }
  const reverse::Violation& violation() const { return violation_; }
  Assembled assembled() const { return {newton_.system(), problem_.fixed_end()}; }
  BlockTridiagonal matrix() const { return assembled().matrix(); }
  /// Returns the right-hand side whose solution is the Newton step.
  BlockVector right_hand_side() const { return assembled().right_hand_side(); }

  /// The first-order conditions (∇L; Φ) with complementarity left out.
  BlockVector conditions() const {
    StageSystem<double> system = newton_.system();
    for (int k = 0; k <= system.h; ++k) {
      const auto level = static_cast<std::size_t>(k);
      system.stages[level].q = newton_.gradient()[level];
      for (int i = 0; i < system.M && k > 0; ++i)
        system.stages[level].e[static_cast<std::size_t>(i)] =
            violation_.residuals[level].segment<3>(3 * i);
    }
    BlockVector r = Assembled(system, problem_.fixed_end()).right_hand_side();
    for (VectorXd& block : r) block = -block;
    return r;
  }

  StageStep<double> step(const BlockVector& solution) const {
    StageStep<double> out(newton_.system().M, newton_.system().h);
    assembled().read(solution, out);
    return out;
  }

  /// The step that a vector of the system stands for; `closing`: the forces close what
  /// complementarity lacks, else they follow the gaps alone (Δλ = b·Δp).
  Direction direction(const BlockVector& solution, bool closing) const {
    const StageStep<double> s = step(solution);
    const StageStep<double> none(newton_.system().M, newton_.system().h);
    reverse::PerContact<double> forces = x_.forces, rest = x_.forces;
    newton_.force_steps(problem_, x_, s, forces);
    newton_.force_steps(problem_, x_, zero(none), rest);
    Direction d;
    for (std::size_t k = 0; k < s.poses.size(); ++k) {
      d.p.push_back(flat(s.poses[k]));
      d.controls.push_back(k > 0 ? Vector3d(s.controls[k]) : Vector3d::Zero());
      d.multipliers.push_back(k > 0 ? flat(s.multipliers[k]) : VectorXd::Zero(d.p[0].size()));
      d.forces.push_back(one_.energy.from_contact_index(forces[k]));
      if (!closing) d.forces.back() -= one_.energy.from_contact_index(rest[k]);
    }
    return d;
  }

 private:
  static VectorXd flat(const BlockColumn<double>& blocks) {
    VectorXd out(3 * static_cast<Eigen::Index>(blocks.size()));
    for (std::size_t i = 0; i < blocks.size(); ++i)
      out.segment<3>(3 * static_cast<Eigen::Index>(i)) = blocks[i];
    return out;
  }
  static StageStep<double> zero(StageStep<double> step) {
    for (BlockColumn<double>& poses : step.poses)
      for (Vec3<double>& block : poses) block.setZero();
    return step;
  }
  reverse::Trajectory<double> loaded(const reverse::ReverseProblem& problem,
                                     const reverse::Iterate& x) {
    problem_.load(0, problem);
    reverse::Trajectory<double> out(problem_.energy, problem.sub_steps);
    out.load(0, problem, x);
    return out;
  }

  const reverse::ReverseProblem& one_;
  reverse::ProblemLanes<double> problem_;
  reverse::Trajectory<double> x_;
  reverse::NewtonSystem<double> newton_;
  reverse::Violation violation_;
};

/// The Newton step.
inline BlockVector solution_of(const Linearisation& lin) {
  const auto solver = make_kkt_solver(KktMethod::kBlockElimination);
  EXPECT_TRUE(solver->factorize(lin.matrix()));
  return solver->solve(lin.right_hand_side());
}

}  // namespace rtg::testing

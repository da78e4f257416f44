#include "core/reverse/problem/reverse_problem.hpp"

#include <algorithm>
#include <utility>

#include "core/reverse/problem/evaluator.hpp"

namespace rtg::reverse {
namespace {

/// Evaluates one iterate with the Evaluator of the solvers.
struct Evaluation {
  ProblemLanes<double> problem;
  Evaluator<double> evaluator;
  Measures<double> measures;

  Evaluation(const ReverseProblem& one, const Iterate& x) : problem(one), evaluator(problem, true) {
    problem.load(0, one);
    Trajectory<double> trajectory(problem.energy, problem.sub_steps);
    trajectory.load(0, one, x);
    PerContact<double> gaps = trajectory.forces;
    for (std::vector<double>& level : gaps) std::ranges::fill(level, 0.0);
    bool legal = true;
    measures = evaluator.evaluate(problem, trajectory, gaps, gaps, legal);
  }
};

}  // namespace

Iterate static_iterate(const ReverseProblem& problem) {
  const auto levels = static_cast<std::size_t>(problem.sub_steps) + 1;
  std::vector<VectorXd> forces(levels, problem.energy.forces(problem.end));
  forces[0] = problem.energy.start_forces(problem.end);
  return {std::vector<VectorXd>(levels, problem.end), std::move(forces),
          std::vector<Vector3d>(levels, Vector3d::Zero()),
          std::vector<VectorXd>(levels, VectorXd::Zero(problem.energy.dofs()))};
}

double objective(const ReverseProblem& problem, const Iterate& x) {
  return Evaluation(problem, x).measures.objective;
}

double Violation::l1() const {
  double sum = 0.0;
  for (const VectorXd& r : residuals) sum += r.lpNorm<1>();
  for (const VectorXd& r : complementarity) sum += r.lpNorm<1>();
  return sum;
}

double Violation::max() const {
  double top = 0.0;
  for (const VectorXd& r : residuals) top = std::max(top, r.lpNorm<Eigen::Infinity>());
  for (const VectorXd& r : complementarity)
    if (r.size() > 0) top = std::max(top, r.lpNorm<Eigen::Infinity>());
  return top;
}

Violation violation(const ReverseProblem& problem, const Iterate& x) {
  const Evaluation at(problem, x);
  Violation v;
  for (const std::vector<double>& r : at.evaluator.residuals())
    v.residuals.push_back(Eigen::Map<const VectorXd>(r.data(), problem.energy.dofs()));
  for (const std::vector<double>& c : at.evaluator.complementarity())
    v.complementarity.push_back(problem.energy.from_contact_index(c));
  return v;
}

SolveStatus status_of_converged(const ReverseProblem& problem, const Iterate& x) {
  return terminal_miss(problem, x) > problem.config.terminal_tolerance ? SolveStatus::kInfeasible
                                                                       : SolveStatus::kConverged;
}

double terminal_miss(const ReverseProblem& problem, const Iterate& x) {
  double most = 0.0;
  for (int i = 0; 3 * i < problem.energy.dofs(); ++i)
    most = std::max(most, (x.p.back() - problem.end).segment<2>(3 * i).norm());
  return most;
}

}  // namespace rtg::reverse

#pragma once

#include <memory>

#include "core/math/assembled_solver.hpp"
#include "core/math/riccati.hpp"
#include "core/reverse/filter_sqp.hpp"

namespace rtg::testing {

/// The solver of the Newton systems that a configuration names, in the one lane of double.
inline std::unique_ptr<StageSolver<double>> stage_solver(const ReverseProblem& problem) {
  const bool fixed_end = problem.config.terminal_weight == 0.0;
  if (problem.config.kkt == KktMethod::kBlockElimination && !fixed_end)
    return std::make_unique<Riccati<double>>(problem.energy.scene().movable(), problem.sub_steps);
  return std::make_unique<AssembledSolver>(problem.config.kkt, fixed_end);
}

/// FilterSqp of one candidate, from its warm start.
inline SqpResult solved(const ReverseProblem& problem) {
  const ReverseProblem* one = &problem;
  return FilterSqp<double>(problem, stage_solver(problem)).solve({&one, 1}).front();
}

/// A trajectory in contact from end to end, where the scene allows: the solution.
inline Iterate in_contact(const ReverseProblem& problem) { return solved(problem).x; }

inline SqpResult solved_from(const ReverseProblem& problem, const Iterate& start) {
  const ReverseProblem* one = &problem;
  return FilterSqp<double>(problem, stage_solver(problem)).solve({&one, 1}, {&start, 1}).front();
}

}  // namespace rtg::testing

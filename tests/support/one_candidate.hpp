#pragma once

#include <gtest/gtest.h>

#include <initializer_list>
#include <memory>

#include "core/energy/implicit_step.hpp"
#include "core/math/assembled_solver.hpp"
#include "core/math/riccati.hpp"
#include "core/reverse/sqp/filter_sqp.hpp"

namespace rtg::testing {

/// The solver of the Newton systems that a configuration names, in the one lane of double.
inline std::unique_ptr<StageSolver<double>> stage_solver(const reverse::ReverseProblem& problem) {
  const bool fixed_end = problem.config.terminal_weight == 0.0;
  if (problem.config.kkt == KktMethod::kBlockElimination && !fixed_end)
    return std::make_unique<Riccati<double>>(problem.energy.scene().movable(), problem.sub_steps);
  return std::make_unique<AssembledSolver>(problem.config.kkt, fixed_end);
}

/// FilterSqp of one candidate, from its warm start.
inline reverse::SqpResult solved(const reverse::ReverseProblem& problem) {
  const reverse::ReverseProblem* one = &problem;
  return reverse::FilterSqp<double>(problem, stage_solver(problem)).solve({&one, 1}).front();
}

/// A trajectory in contact from end to end, where the scene allows: the solution.
inline reverse::Iterate in_contact(const reverse::ReverseProblem& problem) {
  return solved(problem).x;
}

inline reverse::SqpResult solved_from(const reverse::ReverseProblem& problem,
                                      const reverse::Iterate& start) {
  const reverse::ReverseProblem* one = &problem;
  return reverse::FilterSqp<double>(problem, stage_solver(problem))
      .solve({&one, 1}, {&start, 1})
      .front();
}

/// Forward simulation of the trajectory's start, from rest, under its controls.
inline reverse::Iterate replayed(const reverse::ReverseProblem& problem,
                                 const reverse::Iterate& x) {
  reverse::Iterate again = x;
  for (std::size_t k = 1; k < x.p.size(); ++k) {
    again.forces[k - 1] =
        k == 1 ? problem.energy.start_forces(again.p[0]) : problem.energy.forces(again.p[k - 1]);
    const auto step = implicit_step(
        problem.energy, {again.p[k - 1], again.forces[k - 1], &again.p[k > 1 ? k - 2 : 0]},
        energy::Drive<double>::controls(x.controls[k]));
    EXPECT_TRUE(step);
    if (step) again.p[k] = step->next;
  }
  return again;
}

/// Expects the same solution with each of the KKT methods as with block elimination; `config` is
/// that of the problem.
inline void expect_the_same_solution(const reverse::ReverseProblem& problem,
                                     reverse::ReverseConfig& config,
                                     std::initializer_list<KktMethod> methods) {
  const reverse::SqpResult first = solved(problem);
  ASSERT_EQ(first.status, reverse::SolveStatus::kConverged);
  for (const KktMethod method : methods) {
    config.kkt = method;
    const reverse::SqpResult other = solved(problem);
    ASSERT_EQ(other.status, reverse::SolveStatus::kConverged);
    for (std::size_t k = 0; k < first.x.p.size(); ++k)
      EXPECT_LT((other.x.p[k] - first.x.p[k]).norm(), 1e-5) << k;
  }
}

}  // namespace rtg::testing

#pragma once

#include <vector>

#include "core/reverse/problem/reverse_job.hpp"

namespace rtg::fuzz {

/// Returns results of a unit of three jobs with two bodies; the second one has its solution, too.
inline std::vector<reverse::ReverseResult> reverse_results() {
  reverse::ReverseSolution solution;
  solution.trajectory.assign(3, Poses(2));
  solution.controls.assign(2, Vector3d(1.0, 2.0, 3.0));
  solution.contacts.push_back({1, 0, 1, {0.0, 1.0}, {1.0, 0.0}, 2.0});
  std::vector<reverse::ReverseResult> results(3);
  for (auto& result : results) result.predecessors = {Poses(2), Poses(2)};
  results[1].solution = solution;
  return results;
}

}  // namespace rtg::fuzz

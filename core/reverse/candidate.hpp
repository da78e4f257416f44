#pragma once

#include <span>
#include <vector>

#include "core/reverse/problem/reverse_job.hpp"
#include "core/reverse/sqp/sqp_result.hpp"
#include "core/world/selection.hpp"

namespace rtg::reverse {

/// A reverse job as an optimisation problem over the bodies that can take part in the push.
class Candidate {
 public:
  /// `config` must outlive the candidate; `job.end` is finite and has one pose per body.
  Candidate(const Scene& scene, const PhysicsConfig& physics, const PushConfig& push,
            const ReverseConfig& config, const ReverseJob& job);
  Candidate(const Candidate&) = delete;
  Candidate& operator=(const Candidate&) = delete;

  const ReverseProblem& problem() const { return problem_; }
  const std::vector<int>& bodies() const { return bodies_; }  // scene indices, in problem order
  const Scene& scene() const { return part_.scene; }          // of these bodies alone

 private:
  std::vector<int> bodies_;
  Selection part_;
  energy::StepEnergy energy_;
  ReverseProblem problem_;
};

/// Solves candidates with the SQP that their common configuration selects. The results are in the
/// order of the candidates and do not depend on which candidates are solved together. The status
/// is kInfeasible also if a solution misses the given final state by more than the tolerance.
std::vector<SqpResult> solve_together(std::span<const Candidate* const> candidates);

}  // namespace rtg::reverse

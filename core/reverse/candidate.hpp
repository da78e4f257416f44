#pragma once

#include <span>
#include <vector>

#include "core/reverse/problem/reverse_job.hpp"
#include "core/reverse/sqp/sqp_result.hpp"
#include "core/world/selection.hpp"

namespace rtg::reverse {

/// The optimisation problem of one ReverseJob. It covers only the bodies that can take part in the
/// push.
class Candidate {
 public:
  /// `job.end` must be finite and have one pose per body. `config` must outlive the candidate.
  Candidate(const Scene& scene, const PhysicsConfig& physics, const PushConfig& push,
            const ReverseConfig& config, const ReverseJob& job);
  Candidate(const Candidate&) = delete;
  Candidate& operator=(const Candidate&) = delete;

  const ReverseProblem& problem() const { return problem_; }
  void set_pace(double pace) { problem_.pace = pace; }        // at first the least of paces()
  int stride() const { return stride_; }                      // its stride_index()
  const std::vector<int>& bodies() const { return bodies_; }  // scene indices, in problem order
  const Scene& scene() const { return subscene_.scene; }      // of these bodies alone

 private:
  std::vector<int> bodies_;
  int stride_;
  Selection subscene_;
  energy::StepEnergy energy_;
  ReverseProblem problem_;
};

/// Solves candidates with the SQP that their common `config.preset` selects. Returns one result per
/// candidate, in the same order. No result depends on the other candidates. A solution that misses
/// the final state by more than `config.terminal_tolerance` gets the status kInfeasible.
std::vector<SqpResult> solve_together(std::span<const Candidate* const> candidates);

}  // namespace rtg::reverse

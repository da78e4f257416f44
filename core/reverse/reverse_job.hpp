#pragma once

#include "core/reverse/solve_status.hpp"
#include "core/world/pose.hpp"

namespace rtg {

/// Which state, pushed with `action`, ends in `end`?
struct ReverseJob {
  Poses end;
  int action = 0;

  bool operator==(const ReverseJob&) const = default;
};

/// Answer to a ReverseJob. `start` is finite always, and a predecessor only if status is
/// kConverged.
struct ReverseResult {
  SolveStatus status = SolveStatus::kNonFinite;
  int iterations = 0;
  Poses start;
  double cpu_s = 0.0;  // thread CPU time; the one field that is not a function of the job
};

}  // namespace rtg

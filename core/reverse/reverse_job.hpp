#pragma once

#include <vector>

#include "core/reverse/solve_status.hpp"
#include "core/world/pose.hpp"

namespace rtg {

/// Which state, pushed with `action`, ends in `end`?
struct ReverseJob {
  Poses end;
  int action = 0;

  bool operator==(const ReverseJob&) const = default;
};

/// Most predecessors in the answer to one job.
inline constexpr int kMaxStarts = 8;

/// Answer to a ReverseJob. `starts`: predecessors, finite, the one of the whole push first; 1 to
/// kMaxStarts if status is kConverged, else none.
struct ReverseResult {
  SolveStatus status = SolveStatus::kNonFinite;
  int iterations = 0;
  std::vector<Poses> starts = {};
  double cpu_s = 0.0;  // thread CPU time; the one field that is not a function of the job
};

}  // namespace rtg

#pragma once

#include <functional>
#include <span>
#include <vector>

#include "core/reverse/reverse_job.hpp"

namespace rtg {

/// Stands for no push: the scene comes to rest with the robot held.
inline constexpr int kSettle = -1;

/// What does `action` do in `start`?
struct ReplayJob {
  Poses start;
  int action = 0;  // or kSettle

  bool operator==(const ReplayJob&) const = default;
};

struct ReplayResult {
  Poses end;
  bool ok = false;     // as PushOutcome::ok
  double cpu_s = 0.0;  // thread CPU time; the one field that is not a function of the job
};

/// The seams of the search. Results come back in job order, whoever computes them: a loop, a thread
/// pool, processes behind a bus, a lambda in a test. All homes give the same bits.
using SolveBatch = std::function<std::vector<ReverseResult>(std::span<const ReverseJob>)>;
using ReplayBatch = std::function<std::vector<ReplayResult>(std::span<const ReplayJob>)>;

/// One replay job after the other; pure, and callable from several threads at once.
using ReplayOne = std::function<ReplayResult(const ReplayJob&)>;

}  // namespace rtg

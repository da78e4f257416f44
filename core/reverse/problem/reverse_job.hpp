#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "core/math/hash.hpp"
#include "core/reverse/problem/solve_status.hpp"
#include "core/world/pose.hpp"

namespace rtg::reverse {

/// A request for the predecessors of a state: the states from which the push `action` leads to
/// `end`.
struct ReverseJob {
  Poses end;
  int action = 0;

  bool operator==(const ReverseJob&) const = default;
};

/// Returns a hash of a state and an action. Two different pairs have equal hashes with probability
/// 2⁻⁶⁴.
inline std::uint64_t key_of(const Poses& state, int action) {
  std::uint64_t key = hashed(0, static_cast<std::uint64_t>(action));
  for (const Pose& p : state)
    for (const double x : {p.x, p.y, p.theta}) key = hashed(key, std::bit_cast<std::uint64_t>(x));
  return key;
}
inline std::uint64_t key_of(const ReverseJob& job) { return key_of(job.end, job.action); }

/// Largest number of predecessors in the answer to one job.
inline constexpr int kMaxPredecessors = 8;

/// Answer to a ReverseJob. If has_predecessors(status), `predecessors` holds 1 to kMaxPredecessors
/// finite predecessors. Otherwise it is empty. ReverseSimulator puts the start of the whole push
/// first.
struct ReverseResult {
  SolveStatus status = SolveStatus::kNonFinite;
  int iterations = 0;
  std::vector<Poses> predecessors = {};
  double cpu_s = 0.0;  // thread CPU time; the one field that is not a function of the job
};

}  // namespace rtg::reverse

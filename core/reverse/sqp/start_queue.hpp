#pragma once

#include <span>
#include <vector>

#include "core/reverse/problem/warm_start.hpp"

namespace rtg::reverse {

/// Queue of candidates with the trajectories from which their SQP starts. It computes the
/// trajectories of several candidates together, one per SIMD lane of T.
template <class T>
class StartQueue {
 public:
  explicit StartQueue(const ReverseProblem& like);
  StartQueue(const StartQueue&) = delete;  // members refer to each other
  StartQueue& operator=(const StartQueue&) = delete;

  /// Fills the queue with `problems`. `starts` has one trajectory per problem or is empty. If it is
  /// empty, the queue computes warm starts. Where that fails, it uses the static iterate.
  void begin(std::span<const ReverseProblem* const> problems, std::span<const Iterate> starts);

  /// Takes the next candidate from the queue and copies its trajectory to lane l of `x`. Returns
  /// the index of the candidate, or -1 if none is left. If no starts were given, skips candidates
  /// with overlapping bodies in the final state, as they have no warm start.
  int take(int l, Trajectory<T>& x);

 private:
  void prepare();
  void find_starts(const Mask<T>& wanted);

  std::span<const ReverseProblem* const> problems_;
  std::span<const Iterate> starts_;
  std::size_t next_ = 0;    // first candidate not yet prepared
  std::vector<int> ready_;  // candidates by lane; -1: to be skipped
  std::size_t handed_out_ = 0;
  ProblemLanes<T> problem_;
  WarmStart<T> warm_;
  Trajectory<T> x_, warm_x_;
};

}  // namespace rtg::reverse

#pragma once

#include <span>
#include <vector>

#include "core/reverse/problem/warm_start.hpp"

namespace rtg::reverse {

/// Queue of the candidates of a batch, with the trajectories at which their SQP begins. The
/// trajectories of as many candidates as T has lanes are computed together.
template <class T>
class StartQueue {
 public:
  explicit StartQueue(const ReverseProblem& like);
  StartQueue(const StartQueue&) = delete;  // members refer to each other
  StartQueue& operator=(const StartQueue&) = delete;

  /// Begins a batch. `starts` has one entry per problem or is empty. If it is empty, the queue
  /// computes warm starts and, where that fails, uses the static iterate.
  void begin(std::span<const ReverseProblem* const> problems, std::span<const Iterate> starts);

  /// Copies the trajectory of the next candidate to lane l of `x`. Returns the candidate's index,
  /// or -1 if no candidate is left. Without given starts, skips candidates in whose final state
  /// bodies overlap, as they have no warm start.
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

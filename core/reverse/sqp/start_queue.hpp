#pragma once

#include <span>
#include <vector>

#include "core/reverse/problem/warm_start.hpp"

namespace rtg::reverse {

/// The candidates of a batch with the trajectories that their SQP begins with, found for as many at
/// a time as T has lanes.
template <class T>
class StartQueue {
 public:
  explicit StartQueue(const ReverseProblem& like);
  StartQueue(const StartQueue&) = delete;  // parts of it refer to others
  StartQueue& operator=(const StartQueue&) = delete;

  /// `starts`: one per problem, or none at all: then warm starts, and the static iterate where
  /// there is none.
  void begin(std::span<const ReverseProblem* const> problems, std::span<const Iterate> starts);

  /// Index of the next candidate, whose trajectory it puts into lane l of x; -1 if that was all.
  /// Candidates in whose final state bodies overlap have no warm start and are skipped.
  int take(int l, Trajectory<T>& x);

 private:
  void prepare();
  void find_starts(const Mask<T>& wanted);

  std::span<const ReverseProblem* const> problems_;
  std::span<const Iterate> starts_;
  std::size_t next_ = 0;    // not yet prepared
  std::vector<int> ready_;  // by lane; -1: to be skipped
  std::size_t handed_out_ = 0;
  ProblemLanes<T> problem_;
  WarmStart<T> warm_;
  Trajectory<T> x_, warm_x_;
};

}  // namespace rtg::reverse

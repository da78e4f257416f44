#pragma once

#include "core/reverse/problem/reverse_job.hpp"
#include "core/world/push.hpp"
#include "core/world/scene.hpp"

namespace rtg::reverse {

/// Baseline that the reverse simulator must beat: guesses predecessors of a state without physics.
/// The robot moves back by one stride against the push direction d. An object that it touches in
/// front is pulled back by a length L without turning. Bodies that joints connect with the object
/// follow. One that slides on a fixed body moves along its axis alone.
///
///   start(robot) = end(robot) - stride·d,   start(object) = end(object) - L·d
///
/// The robot may have met the object anywhere on its way. So solve() draws kMaxPredecessors values
/// of L from [0.2, 1]·stride; equal jobs give equal values. The status is
///
///   kPruned      if the robot would start outside the arena or a body blocks its way back,
///   kInfeasible  if bodies overlap for every L or if the object hangs on a fixed body otherwise.
class NaiveReverse {
 public:
  NaiveReverse(Scene scene, PushConfig push);

  [[nodiscard]] ReverseResult solve(const ReverseJob& job) const;

 private:
  std::vector<Poses> pulled(const ReverseJob& job, std::size_t object, const Poses& start) const;
  bool blocked(const Poses& end, std::size_t touched, const Vector2d& back) const;
  std::size_t touched_object(const Poses& end, const Vector2d& ahead) const;

  Scene scene_;
  PushConfig push_;
  std::vector<std::size_t> roots_;  // moving_group_roots(scene_)
};

}  // namespace rtg::reverse

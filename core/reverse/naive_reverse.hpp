#pragma once

#include "core/reverse/problem/reverse_job.hpp"
#include "core/world/push.hpp"
#include "core/world/scene.hpp"

namespace rtg::reverse {

/// Guesses predecessors kinematically, without any physics. The robot moves back by one stride
/// against its heading. The one object that the robot touches in front, if any, is pulled back
/// without turning, together with the bodies that joints connect with it. NaiveReverse is the
/// baseline that the reverse simulator must beat.
///
///   start(robot) = end(robot) - stride·d,   start(object) = end(object) - L·d
///
/// The robot may have met the object anywhere on its way, so L is drawn kMaxStarts times from
/// [0.2, 1]·stride. The draws are a function of the job. The status is kPruned if the robot would
/// start outside the arena or if its way back is blocked. The status is kInfeasible if bodies would
/// overlap with every L, or if joints connect the object with a fixed root.
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
  std::vector<std::size_t> roots_;  // roots_of(scene_)
};

}  // namespace rtg::reverse

#pragma once

#include "core/reverse/problem/reverse_job.hpp"
#include "core/world/push.hpp"
#include "core/world/scene.hpp"

namespace rtg::reverse {

/// Kinematic guess of predecessors, without any physics: the robot moves back one stride against
/// its heading; the one object that it touches in front (if any) is pulled back with it, unturned,
/// and with it what joints connect. The baseline that the reverse simulator must beat.
///
///   start(robot) = end(robot) - stride·d,   start(object) = end(object) - L·d
///
/// L is drawn from [0.2, 1]·stride, kMaxStarts times as a function of the job: the robot may have
/// met the object anywhere on its way. Statuses: kPruned if the robot would start outside of the
/// arena or its way back is blocked; kInfeasible if bodies would overlap with every L, or if the
/// object hangs on a fixed body.
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
  std::vector<std::size_t> roots_;  // as roots_of()
};

}  // namespace rtg::reverse

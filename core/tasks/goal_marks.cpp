#include "core/tasks/goal_marks.hpp"

#include "core/world/outline.hpp"

namespace rtg::tasks {
namespace {

constexpr double kFar = 4.0;  // half the size of a half-plane, in units of the arena's

/// Adds the marks of a term's condition.
struct Marks {
  const Task& task;
  const GoalTerm& term;
  std::vector<GoalMark>& to;

  void operator()(const CentreIn& c) const { add_region(c.region); }
  void operator()(const MeanIn& c) const { add_region(c.region); }
  void operator()(const PoseNear& c) const { add_target(c.pose); }
  void operator()(const Covers& c) const { add_target(c.pose); }
  void operator()(const Stays& c) const {
    for (std::size_t i = 1; i < task.scene.size(); ++i)
      if (concerns(term, task.scene, i)) add_region(Disc{task.start[i].position(), c.distance});
  }
  template <class Other>
  void operator()(const Other&) const {}

 private:
  void add_region(const Region& region) const {
    to.push_back({term.kind, ring_of(region, kFar * task.push.arena), false, term.negated});
  }

  /// The outline of the first body that is to lie there.
  void add_target(const Pose& pose) const {
    for (std::size_t i = 1; i < task.scene.size(); ++i) {
      if (!concerns(term, task.scene, i)) continue;
      std::vector<Vector2d> ring = outline(task.scene.bodies[i].shape.parts())[0];
      for (Vector2d& v : ring) v = to_world(pose, v);
      to.push_back({task.scene.bodies[i].kind, std::move(ring), true, term.negated});
      return;
    }
  }
};

}  // namespace

std::vector<GoalMark> goal_marks(const Task& task) {
  std::vector<GoalMark> marks;
  for (const GoalTerm& term : task.goal) std::visit(Marks{task, term, marks}, term.condition);
  return marks;
}

}  // namespace rtg::tasks

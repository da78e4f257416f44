#include "core/tasks/goal_marks.hpp"

#include <algorithm>

#include "core/world/outline.hpp"

namespace rtg::tasks {
namespace {

constexpr double kFar = 4.0;  // half the size of a half-plane, in units of the arena's
constexpr int kSwept = 8;     // steps from the least value of a joint to the most

/// Returns the outline of a body, without its holes.
std::vector<Vector2d> outline_at(const Body& body, const Pose& pose) {
  std::vector<Vector2d> ring = outline(body.shape.parts())[0];
  for (Vector2d& v : ring) v = to_world(pose, v);
  return ring;
}

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
      const Body& body = task.scene.bodies[i];
      to.push_back({body.kind, outline_at(body, pose), true, term.negated});
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

std::vector<GoalMark> joint_marks(const Task& task, const Poses& poses) {
  std::vector<GoalMark> marks;
  for (const GoalTerm& term : task.goal)
    for (const Joint& joint : task.scene.joints) {
      if (!concerns(term, task.scene, joint)) continue;
      const auto& range = std::get<JointIn>(term.condition);
      const double least = std::max(range.least, joint.lower);
      const double most = std::min(range.most, joint.upper);
      if (least > most) continue;
      const auto child = static_cast<std::size_t>(joint.child);
      const Body& body = task.scene.bodies[child];
      Poses moved = poses;
      for (int k = 0; k <= kSwept; ++k) {
        set_joint_value(joint, least + (most - least) * k / kSwept, moved);
        marks.push_back({body.kind, outline_at(body, moved[child]), k % kSwept == 0, term.negated});
      }
    }
  return marks;
}

}  // namespace rtg::tasks

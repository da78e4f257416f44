#include "core/tasks/goal_marks.hpp"

#include <algorithm>
#include <numbers>

#include "core/math/elementary.hpp"
#include "core/tasks/symmetry.hpp"
#include "core/world/outline.hpp"

namespace rtg::tasks {
namespace {

constexpr double kFar = 4.0;     // half the size of a half-plane, in units of the arena's
constexpr int kSwept = 8;        // steps from the least value of a joint to the most
constexpr int kArc = 32;         // edges of an arc
constexpr double kSector = 1.5;  // radius of a sector, in units of the body's

/// Returns the outline of a body, grown by `gap` and without its holes.
std::vector<Vector2d> outline_at(const Body& body, const Pose& pose, double gap = 0.0) {
  std::vector<Part> parts = body.shape.parts();
  for (Part& part : parts) part.radius += gap;
  std::vector<Vector2d> ring = outline(parts)[0];
  for (Vector2d& v : ring) v = to_world(pose, v);
  return ring;
}

/// Returns the directions from `least` to `most` [rad] around a body at `centre`, as a sector.
std::vector<Vector2d> sector(const Body& body, const Vector2d& centre, double least, double most) {
  std::vector<Vector2d> ring{centre};
  for (int k = 0; k <= kArc; ++k) {
    const Turn<double> turn = turn_of(least + (most - least) * k / kArc);
    ring.push_back(centre + kSector * body.shape.radius() * Vector2d(turn.c, turn.s));
  }
  return ring;
}

/// Adds the marks of a term's condition that stay where they are.
struct Marks {
  const Task& task;
  const GoalTerm& term;
  std::vector<GoalMark>& to;

  void operator()(const CentreIn& c) const { add_region(c.region); }
  void operator()(const MeanIn& c) const { add_region(c.region); }
  void operator()(const PoseNear& c) const {
    add_target(c.pose, [&](const Body& body) {
      const double least = c.pose.theta - c.turn, most = c.pose.theta + c.turn;
      to.push_back({term.kind, sector(body, c.pose.position(), least, most), false, term.negated});
    });
    add_region(Disc{c.pose.position(), c.distance});
  }
  void operator()(const Covers& c) const {
    add_target(c.pose, [](const Body&) {});
  }
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

  /// Adds the outline of each shape that is to lie there, and what `more` adds for its body.
  template <class More>
  void add_target(const Pose& pose, const More& more) const {
    const std::size_t first = to.size();
    for (std::size_t i = 1; i < task.scene.size(); ++i) {
      if (!concerns(term, task.scene, i)) continue;
      const Body& body = task.scene.bodies[i];
      GoalMark mark{body.kind, outline_at(body, pose), true, term.negated};
      const auto is_same = [&](const GoalMark& m) {
        return m.kind == mark.kind && m.ring == mark.ring;
      };
      if (std::any_of(to.begin() + static_cast<std::ptrdiff_t>(first), to.end(), is_same)) continue;
      to.push_back(std::move(mark));
      more(body);
    }
  }
};

/// Adds the marks of a term's condition that go with the bodies.
struct BodyMarks {
  const Task& task;
  const GoalTerm& term;
  const Poses& poses;
  std::vector<GoalMark>& to;

  void operator()(const AngleIn& c) const {
    for (std::size_t i = 1; i < task.scene.size(); ++i) {
      if (!concerns(term, task.scene, i)) continue;
      const double period = turn_period(task.scene, i);
      const double off = poses[i].theta - (c.least + c.most) / 2.0;
      const double turn = period > 0.0 ? period * std::round(off / period) : 0.0;
      const Body& body = task.scene.bodies[i];
      to.push_back({body.kind, sector(body, poses[i].position(), c.least + turn, c.most + turn),
                    false, term.negated});
    }
  }
  void operator()(const Touches& c) const { add_bands(c.other, c.gap, term.negated); }
  void operator()(const KeepsFrom& c) const { add_bands(c.other, c.gap, !term.negated); }
  template <class Other>
  void operator()(const Other&) const {}

 private:
  void add_bands(const std::string& other, double gap, bool negated) const {
    for (std::size_t i = 1; i < task.scene.size(); ++i) {
      const Body& body = task.scene.bodies[i];
      if (other == "*" ? !body.fixed : body.kind == other)
        to.push_back({term.kind, outline_at(body, poses[i], gap), false, negated});
    }
  }
};

}  // namespace

std::vector<GoalMark> goal_marks(const Task& task) {
  std::vector<GoalMark> marks;
  for (const GoalTerm& term : task.goal) std::visit(Marks{task, term, marks}, term.condition);
  return marks;
}

std::vector<GoalMark> body_marks(const Task& task, const Poses& poses) {
  std::vector<GoalMark> marks;
  for (const GoalTerm& term : task.goal)
    std::visit(BodyMarks{task, term, poses, marks}, term.condition);
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

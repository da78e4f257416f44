#include "core/tasks/goal.hpp"

#include <algorithm>

namespace rtg {

bool concerns(const GoalTerm& term, const Scene& scene, std::size_t body) {
  if (body == 0 || term.subject == GoalTerm::Subject::kJoint) return false;
  const Body& one = scene.bodies[body];
  return term.kind == "*" ? !one.fixed : term.kind == one.kind;
}

bool concerns(const GoalTerm& term, const Scene& scene, const Joint& joint) {
  if (term.subject != GoalTerm::Subject::kJoint) return false;
  return term.kind == "*" || term.kind == scene.bodies[static_cast<std::size_t>(joint.child)].name;
}

bool contains(const GoalTerm& term, const Vector2d& x, double tighten) {
  if (term.region == GoalTerm::Region::kDisc)
    return (x - term.centre).norm() <= term.radius - tighten;
  return term.normal.dot(x) <= term.offset - tighten;
}

bool contains(const GoalTerm& term, double angle, double tighten) {
  return angle >= term.least + tighten && angle <= term.most - tighten;
}

Vector2d centroid_of(const GoalTerm& term, const Scene& scene, const Poses& poses) {
  Vector2d sum = Vector2d::Zero();
  double count = 0.0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    if (!concerns(term, scene, i)) continue;
    sum += poses[i].position();
    count += 1.0;
  }
  return sum / count;
}

std::vector<bool> atoms(const GoalTerm& term, const Scene& scene, const Poses& poses,
                        double tighten) {
  std::vector<bool> held;
  switch (term.subject) {
    case GoalTerm::Subject::kEvery:
      for (std::size_t i = 1; i < poses.size(); ++i)
        if (concerns(term, scene, i)) held.push_back(contains(term, poses[i].position(), tighten));
      break;
    case GoalTerm::Subject::kCentroid:
      held.push_back(contains(term, centroid_of(term, scene, poses), tighten));
      break;
    case GoalTerm::Subject::kJoint:
      for (const Joint& joint : scene.joints)
        if (concerns(term, scene, joint))
          held.push_back(contains(term, joint_angle(joint, poses), tighten));
      break;
  }
  return held;
}

bool holds(const GoalTerm& term, const Scene& scene, const Poses& poses, double tighten) {
  const std::vector<bool> held = atoms(term, scene, poses, tighten);
  return std::ranges::all_of(held, [](bool one) { return one; });
}

}  // namespace rtg

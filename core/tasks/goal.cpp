#include "core/tasks/goal.hpp"

#include <algorithm>

namespace rtg::tasks {
namespace {

/// Calls visit(holds) for each single condition of `term`: one per body (kEvery), one per joint
/// (kJoint), or one for the mean (kCentroid). `holds` is true if the point or angle lies in the
/// shrunk region. Allocates no memory, as searches test goals very often.
template <class Visit>
void for_each_atom(const GoalTerm& term, const Scene& scene, const Poses& poses, double tighten,
                   Visit visit) {
  switch (term.subject) {
    case GoalTerm::Subject::kEvery:
      for (std::size_t i = 1; i < poses.size(); ++i)
        if (concerns(term, scene, i)) visit(contains(term, poses[i].position(), tighten));
      break;
    case GoalTerm::Subject::kCentroid:
      visit(contains(term, centroid_of(term, scene, poses), tighten));
      break;
    case GoalTerm::Subject::kJoint:
      for (const Joint& joint : scene.joints)
        if (concerns(term, scene, joint)) visit(contains(term, joint_angle(joint, poses), tighten));
      break;
  }
}

}  // namespace

bool concerns(const GoalTerm& term, const Scene& scene, std::size_t body) {
  if (body == 0 || term.subject == GoalTerm::Subject::kJoint) return false;
  const Body& one = scene.bodies[body];
  return term.kind == "*" ? !one.fixed : term.kind == one.kind;
}

bool concerns(const GoalTerm& term, const Scene& scene, const Joint& joint) {
  if (term.subject != GoalTerm::Subject::kJoint) return false;
  return term.kind == "*" || term.kind == scene.bodies[static_cast<std::size_t>(joint.child)].name;
}

double excess(const GoalTerm& term, const Vector2d& x) {
  if (term.region == GoalTerm::Region::kDisc) return (x - term.centre).norm() - term.radius;
  return term.normal.dot(x) - term.offset;
}

double excess(const GoalTerm& term, double angle) {
  return std::max(term.least - angle, angle - term.most);
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

bool holds(const GoalTerm& term, const Scene& scene, const Poses& poses, double tighten) {
  bool all = true;
  for_each_atom(term, scene, poses, tighten, [&all](bool one) { all = all && one; });
  return all;
}

}  // namespace rtg::tasks

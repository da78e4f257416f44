#pragma once

#include <string>
#include <vector>

#include "core/world/scene.hpp"

namespace rtg::tasks {

/// A condition on a state: the subject of the term must lie in its region. A goal is a list of
/// terms, all of which must hold. The subjects are:
///
///   kEvery     the centre of every body of the kind ("*": of every movable body but the robot)
///   kCentroid  the mean of these centres
///   kJoint     θ_child - θ_parent of the joint whose child has that name ("*": of every joint)
struct GoalTerm {
  enum class Subject { kEvery, kCentroid, kJoint };
  enum class Region { kDisc, kHalfPlane, kAngles };
  std::string kind = "*";  // kind of body; for kJoint, name of the joint's child
  Region region = Region::kDisc;
  Vector2d centre = Vector2d::Zero();   // kDisc: |x - centre| ≤ radius
  double radius = 0.0;                  // [m]
  Vector2d normal = Vector2d::UnitX();  // kHalfPlane: normal·x ≤ offset, |normal| = 1
  double offset = 0.0;                  // [m]
  Subject subject = Subject::kEvery;
  double least = 0.0, most = 0.0;  // kAngles: least ≤ φ ≤ most [rad]

  bool operator==(const GoalTerm&) const = default;
};

/// Returns whether `term` is about the position of `body`, alone (kEvery) or in a mean (kCentroid).
/// Always false for the robot.
bool concerns(const GoalTerm& term, const Scene& scene, std::size_t body);
/// Returns whether `term` applies to the angle of `joint`.
bool concerns(const GoalTerm& term, const Scene& scene, const Joint& joint);

/// Returns how far a point [m] or an angle [rad] lies outside the region of `term`. The result is
/// negative or zero inside.
double excess(const GoalTerm& term, const Vector2d& x);
double excess(const GoalTerm& term, double angle);

/// Returns whether a point or an angle lies in the region of `term`, shrunk by `tighten` ([m] or
/// [rad]).
inline bool contains(const GoalTerm& term, const Vector2d& x, double tighten) {
  return excess(term, x) <= -tighten;
}
inline bool contains(const GoalTerm& term, double angle, double tighten) {
  return excess(term, angle) <= -tighten;
}

/// Returns the mean centre of the bodies to which `term` applies.
Vector2d centroid_of(const GoalTerm& term, const Scene& scene, const Poses& poses);

/// Returns whether `term` holds with its region shrunk by `tighten` ([m] or [rad]).
bool holds(const GoalTerm& term, const Scene& scene, const Poses& poses, double tighten);

}  // namespace rtg::tasks

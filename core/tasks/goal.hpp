#pragma once

#include <string>
#include <variant>
#include <vector>

#include "core/tasks/region.hpp"
#include "core/world/scene.hpp"

namespace rtg::tasks {

struct Task;

// Conditions on a state. Those on a body are to hold for every body of a kind. Angles of bodies
// count modulo the symmetry of their shape.

/// The centre of the body lies in the region.
struct CentreIn {
  Region region;
  bool operator==(const CentreIn&) const = default;
};
/// The mean of the centres of all bodies of the kind lies in the region.
struct MeanIn {
  Region region;
  bool operator==(const MeanIn&) const = default;
};
/// least ≤ θ ≤ most.
struct AngleIn {
  double least = 0.0, most = 0.0;  // [rad]
  bool operator==(const AngleIn&) const = default;
};
/// The centre is within `distance` of that of `pose`, the angle within `turn` of its angle.
struct PoseNear {
  Pose pose;
  double distance = 0.0;  // [m]
  double turn = 0.0;      // [rad]
  bool operator==(const PoseNear&) const = default;
};
/// The body covers at least `share` of its own outline at `pose`.
struct Covers {
  Pose pose;
  double share = 0.0;
  bool operator==(const Covers&) const = default;
};
/// The separation from the nearest other body of kind `other` is at most `gap`.
struct Touches {
  std::string other;
  double gap = 0.0;  // [m]
  bool operator==(const Touches&) const = default;
};
/// The separation from every other body of kind `other` is at least `gap`.
struct KeepsFrom {
  std::string other;
  double gap = 0.0;  // [m]
  bool operator==(const KeepsFrom&) const = default;
};
/// The centre is within `distance` of where the body is in Task::start.
struct Stays {
  double distance = 0.0;  // [m]
  bool operator==(const Stays&) const = default;
};
/// least ≤ joint_value() ≤ most, of the joint of this type whose child has the name `kind` of the
/// term.
struct JointIn {
  double least = 0.0, most = 0.0;  // [rad], of a prismatic joint [m]
  JointType type = JointType::kRevolute;
  bool operator==(const JointIn&) const = default;
};

using Condition =
    std::variant<CentreIn, MeanIn, AngleIn, PoseNear, Covers, Touches, KeepsFrom, Stays, JointIn>;

/// A term of a goal, which is a list of terms that all must hold. With `negated` its condition is
/// to hold for no body of the kind (for no joint, not for the mean).
struct GoalTerm {
  std::string kind = "*";  // "*": every movable body but the robot, every joint
  Condition condition;
  bool negated = false;

  bool operator==(const GoalTerm&) const = default;
};

/// Returns whether `term` is about the position of `body`, alone or in a mean. Always false for the
/// robot.
bool concerns(const GoalTerm& term, const Scene& scene, std::size_t body);
/// Returns whether `term` applies to `joint`.
bool concerns(const GoalTerm& term, const Scene& scene, const Joint& joint);

/// Returns whether the condition of `term` is about bodies one by one, whatever lies beside them.
bool is_of_one_body(const GoalTerm& term);

/// Returns how far `body`, which `term` concerns, is from meeting it; zero or less if it does. The
/// unit is [m], for angles [rad]. Not for JointIn and MeanIn.
double excess(const GoalTerm& term, const Task& task, const Poses& poses, std::size_t body);
/// The same for a joint and JointIn.
double excess(const GoalTerm& term, const Joint& joint, const Poses& poses);

/// Returns the mean centre of the bodies to which `term` applies.
Vector2d centroid_of(const GoalTerm& term, const Scene& scene, const Poses& poses);

/// Returns whether `term` holds.
bool holds(const GoalTerm& term, const Task& task, const Poses& poses);

/// Margin by which states of sample_goal() satisfy the goal [m], [rad]; less where a term leaves
/// little room.
inline constexpr double kGoalSpare = 0.05;

/// Returns a term that holds only where `term` holds with a margin: kGoalSpare, but at most a fifth
/// of what the term allows.
GoalTerm tightened(const GoalTerm& term, const Scene& scene);

}  // namespace rtg::tasks

#include "core/tasks/goal_distance.hpp"

#include <algorithm>
#include <limits>

namespace rtg::tasks {
namespace {

constexpr double kRobotWeight = 0.2;  // w of goal_distance()

/// Accumulates the two parts of goal_distance(): the sum and the minimum.
struct Distance {
  const Poses& poses;
  double violation = 0.0;
  double least_robot_distance = std::numeric_limits<double>::infinity();

  /// Adds the violation of a condition whose point or angle lies `off` outside its region (≤ 0:
  /// inside).
  void violate(double off) { violation += std::max(0.0, off); }

  /// Takes the distance from the robot to `body` into the minimum, if a condition on `body` does
  /// not hold (`off` > 0).
  void note_robot_distance(std::size_t body, double off) {
    if (off > 0.0)
      least_robot_distance =
          std::min(least_robot_distance, (poses[body].position() - poses[0].position()).norm());
  }
};

void add(Distance& d, const GoalTerm& term, const Scene& scene) {
  if (term.subject == GoalTerm::Subject::kJoint) {
    for (const Joint& joint : scene.joints) {
      if (!concerns(term, scene, joint)) continue;
      const double off = excess(term, joint_angle(joint, d.poses));
      d.violate(off);
      d.note_robot_distance(static_cast<std::size_t>(joint.parent), off);
      d.note_robot_distance(static_cast<std::size_t>(joint.child), off);
    }
    return;
  }
  const bool together = term.subject == GoalTerm::Subject::kCentroid;
  const double of_mean = together ? excess(term, centroid_of(term, scene, d.poses)) : 0.0;
  d.violate(of_mean);
  for (std::size_t k = 1; k < d.poses.size(); ++k) {
    if (!concerns(term, scene, k)) continue;
    const double off = together ? of_mean : excess(term, d.poses[k].position());
    if (!together) d.violate(off);
    d.note_robot_distance(k, off);
  }
}

}  // namespace

double goal_distance(const Task& task, const Poses& poses) {
  Distance d{poses};
  for (const GoalTerm& term : task.goal) add(d, term, task.scene);
  return d.violation > 0.0 ? d.violation + kRobotWeight * d.least_robot_distance : 0.0;
}

}  // namespace rtg::tasks

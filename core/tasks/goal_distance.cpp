#include "core/tasks/goal_distance.hpp"

#include <algorithm>
#include <limits>

#include "core/tasks/goal_atoms.hpp"

namespace rtg::tasks {
namespace {

constexpr double kRobotWeight = 0.2;  // w of goal_distance()

}  // namespace

double goal_distance(const Task& task, const Poses& poses) {
  double violation = 0.0, least_robot_distance = std::numeric_limits<double>::infinity();
  for (const GoalTerm& term : task.goal) {
    const bool of_mean = std::holds_alternative<MeanIn>(term.condition);
    double of_term = 0.0;
    for_each_atom(term, task, poses, [&](const Atom& atom) {
      if (atom.excess <= 0.0) return;
      of_term = of_mean ? atom.excess : of_term + atom.excess;
      for (const std::size_t body : {atom.body, atom.second})
        if (body > 0)
          least_robot_distance =
              std::min(least_robot_distance, (poses[body].position() - poses[0].position()).norm());
    });
    violation += of_term;
  }
  return violation > 0.0 ? violation + kRobotWeight * least_robot_distance : 0.0;
}

}  // namespace rtg::tasks

#pragma once

#include <string>

#include "core/math/vectors.hpp"
#include "core/tasks/task.hpp"

namespace rtg::testing {

inline void add_box(tasks::Task& task, const Pose& pose) {
  const std::string name = "box" + std::to_string(task.scene.size());
  task.scene.bodies.push_back({name, "box", box(1.2, 1.2), 1.0, 0.5, false});
  task.start.push_back(to_single(pose));
}

/// The goal that all objects lie within `radius` of the origin [m].
inline std::vector<tasks::GoalTerm> near_origin(double radius) {
  return {{"*", tasks::CentreIn{tasks::Disc{Vector2d::Zero(), radius}}}};
}

/// The task of config/gathering.yaml, for tests of the core, which reads no YAML.
inline tasks::Task gathering() {
  tasks::Task task;
  task.name = "gathering";
  task.scene.bodies.push_back({"robot", "robot", regular_polygon(6, 0.8), 1.0, 0.5, false});
  task.start.push_back({0.0, -5.0, 0.0});
  add_box(task, {-3.0, 1.13, 0.2});
  add_box(task, {2.63, 2.25, -0.3});
  add_box(task, {2.25, -2.25, 0.6});
  task.goal = near_origin(2.0);
  task.randomisation = 0.5;
  return task;
}

/// Gathering's start with the robot at x: places on a line.
inline Poses robot_at(double x) {
  Poses poses = gathering().start;
  poses[0].x = x;
  return poses;
}

/// The task of config/gathering_hard.yaml.
inline tasks::Task gathering_hard() {
  tasks::Task task = gathering();
  task.name = "gathering_hard";
  add_box(task, {-1.88, -2.63, 0.1});
  return task;
}

/// Returns Gathering's robot and boxes, `bodies` in all, for row_poses().
inline Scene row_of_boxes(int bodies) {
  const tasks::Task task = gathering();
  Scene row{{task.scene.bodies[0]}};
  row.bodies.resize(static_cast<std::size_t>(bodies), task.scene.bodies[1]);
  return row;
}

/// Returns the poses in which they stand in a row, nearly touching [3·bodies].
inline VectorXd row_poses(int bodies) {
  VectorXd p = VectorXd::Zero(3 * bodies);
  for (int k = 1; k < bodies; ++k) p[3 * k] = 1.46 + 1.28 * (k - 1);
  return p;
}

}  // namespace rtg::testing

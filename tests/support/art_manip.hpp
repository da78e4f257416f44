#pragma once

#include <string>

#include "core/tasks/task.hpp"

namespace rtg::testing {

/// The task of config/art_manip.yaml.
inline tasks::Task art_manip() {
  tasks::Task task;
  task.name = "art_manip";
  task.scene.bodies.push_back({"robot", "robot", regular_polygon(6, 0.8), 1.0, 0.5, false});
  task.start.push_back({0.0, -4.0, 0.0});
  for (int k = 1; k <= 4; ++k) {
    task.scene.bodies.push_back(
        {"link" + std::to_string(k), "link", box(2.4, 0.7), 1.0, 0.5, false});
    task.start.push_back(to_single({-6.0 + 2.4 * k, 0.0, 0.0}));
    if (k > 1) task.scene.joints.push_back({k - 1, k, {1.2, 0.0}, {-1.2, 0.0}, -2.391, 2.391});
  }
  task.start = with_closed_joints(task.scene, task.start);
  task.start = to_single(task.start);
  task.goal = {{"*", tasks::JointIn{1.309, 1.833}},
               {"link", tasks::MeanIn{tasks::Disc{{0.0, 3.0}, 1.0}}}};
  task.discount = 0.9;
  task.randomisation = 0.5;
  return task;
}

}  // namespace rtg::testing

#pragma once

#include <string>

namespace rtg::testing {

/// A small legal configuration whose last section is the task.
inline const std::string kTwoBoxes = R"(task:
  name: two_boxes
  bodies:
    - {name: robot, kind: robot, shape: {regular: {sides: 6, radius: 0.8}}, start: [0, -5, 0]}
    - {name: a, kind: box, shape: {box: [1, 1]}, start: [3, 0, 0]}
    - {name: b, kind: box, shape: {box: [1, 1]}, start: [-3, 0, 0]}
  goal:
    - {kind: box, disc: {centre: [0, 0], radius: 2}}
)";

}  // namespace rtg::testing

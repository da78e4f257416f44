#pragma once

#include <optional>
#include <string>

#include "core/tasks/task.hpp"
#include "nodes/config/config_tree.hpp"
#include "nodes/config/field_reader.hpp"

namespace rtg::config {

/// Where a body starts. With a range, `pose` is its middle.
struct Start {
  Pose pose;
  std::optional<tasks::StartRange> range;
};

/// Reads the key `start` of a body. Legal are
///
///   [x, y, theta]
///   {x: a, y: b, theta: c}           each a number or a range [least, most]
///   {in: {region}, theta: [a, b]}    a disc, box or polygon
///
/// Without theta a range is of any angle; the robot's angle is 0. Throws ConfigError for anything
/// else.
Start read_start(const FieldReader& body, bool is_robot);

/// Converts a start to a value, from which read_start() reads it back.
ConfigNode start_node(const Pose& pose, const std::optional<tasks::StartRange>& range,
                      const tasks::Units& units);

/// Draws task.start from the ranges, if there are any; always the same state. Throws ConfigError if
/// 1000 draws are not legal. `section`: that of the task, for messages.
void draw_nominal_start(tasks::Task& task, const ConfigNode& section);

}  // namespace rtg::config

#pragma once

#include <string>

#include "core/tasks/units.hpp"
#include "nodes/config/field_reader.hpp"

namespace rtg::config {

/// Returns the units of a task. That of length follows from the key `scale` of the section `task`,
/// else from the bounding radius of the body `robot`; that of density from the robot's. A robot
/// whose shape is not legal counts as one of kRobotRadius metres. Throws ConfigError if a value is
/// not legal.
tasks::Units read_units(const FieldReader& task, const ConfigNode& robot);

/// Returns the text of the key `scale` from which read_units() reads `units.length` back.
std::string scale_text(const tasks::Units& units);

}  // namespace rtg::config

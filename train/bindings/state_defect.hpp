#pragma once

#include <string>

#include "core/tasks/task.hpp"

namespace rtg::bindings {

/// Returns why bodies cannot be where they are, in words with lengths in metres: fixed ones off
/// their places, others out of twice the arena. Empty if they can.
std::string place_defect(const tasks::Task& task, const Poses& poses);

/// Returns why no episode can be in a state: numbers that are not finite, place_defect(), or bodies
/// that overlap by more than simulators let them. Empty if one can.
std::string state_defect(const tasks::Task& task, const Poses& poses);

}  // namespace rtg::bindings

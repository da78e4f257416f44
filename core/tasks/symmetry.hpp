#pragma once

#include <cstddef>
#include <vector>

#include "core/tasks/task.hpp"

namespace rtg::tasks {

/// Returns the movable objects in groups of interchangeable ones: to swap two bodies of a group
/// changes neither what pushes do nor whether the goal holds. They have no joint, and equal kind,
/// shape, density and friction; no term says that they stay where they are. Every object is in one
/// group, most often alone in it. Groups and their members are in the order of the scene.
std::vector<std::vector<std::size_t>> interchangeable(const Task& task);

/// Returns the angle by which body `i` can be turned without a change to pushes or goal [rad]: that
/// of its shape, but 2π with a joint; 0 of discs.
double turn_period(const Scene& scene, std::size_t i);

}  // namespace rtg::tasks

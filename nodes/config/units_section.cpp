#include "nodes/config/units_section.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "nodes/config/shape_section.hpp"

namespace rtg::config {
namespace {

using Kind = ConfigNode::Kind;

constexpr double kLeast = 1e-9, kMost = 1e9;  // scale [m], density of the robot [kg/m²]
constexpr double kNearSize = 3.0;  // largest number of the robot's shape in its own units
constexpr int kDigits = 14;        // of the robot's radius; the rest are rounding errors

/// Returns the largest magnitude of a number in the tree, but for numbers of sides.
double largest_number(const ConfigNode& node) {
  double largest = 0.0;
  if (node.kind == Kind::kScalar) {
    const std::string& text = node.scalar;
    std::from_chars(text.data(), text.data() + text.size(), largest);
    return std::isfinite(largest) ? std::abs(largest) : 0.0;
  }
  for (const ConfigNode& item : node.items) largest = std::max(largest, largest_number(item));
  for (const ConfigEntry& entry : node.entries)
    if (entry.key != "sides") largest = std::max(largest, largest_number(entry.value));
  return largest;
}

double with_digits(double x, int digits) {
  const double unit = std::pow(10.0, digits - 1 - std::floor(std::log10(x)));
  return std::round(x * unit) / unit;
}

/// Returns the bounding radius of the robot [m], or kRobotRadius if its shape is not legal: the
/// reader of the shape will then say why.
double robot_radius(const ConfigNode& robot) {
  if (robot.kind != Kind::kMap) return tasks::kRobotRadius;
  const ConfigEntry* shape = find(robot, "shape");
  const double largest = shape ? largest_number(shape->value) : 0.0;
  if (largest < kLeast || largest > kMost) return tasks::kRobotRadius;
  // Of the size of the robot, so that robots that differ in scale alone have the same numbers
  // there; not rounded, because what is rounded there would not be in the units of the task.
  const tasks::Units near{largest / kNearSize, 1.0, false};
  try {
    const double radius = read_shape(shape->value, "", near).radius() * near.length;
    return with_digits(radius, kDigits);
  } catch (const ConfigError&) {
    return tasks::kRobotRadius;
  }
}

}  // namespace

tasks::Units read_units(const FieldReader& task, const ConfigNode& robot) {
  double scale = 0.0;
  if (const ConfigEntry* given = find(task.section(), "scale"))
    scale = read_number(given->value, task.path("scale"), kLeast, kMost, "m");
  if (scale == 0.0) scale = robot_radius(robot);
  tasks::Units units{scale / tasks::kRobotRadius, 1.0};
  if (robot.kind != Kind::kMap) return units;
  if (const ConfigEntry* density = find(robot, "density"))
    units.density = read_number(density->value, "task.bodies.0.density", kLeast, kMost, "kg/m²");
  return units;
}

std::string scale_text(const tasks::Units& units) {
  return shortest_text(units.length * tasks::kRobotRadius,
                       [&](double scale) { return scale / tasks::kRobotRadius == units.length; });
}

}  // namespace rtg::config

#include "nodes/config/joint_section.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "nodes/config/config_error.hpp"
#include "nodes/config/field_reader.hpp"
#include "nodes/config/suggestion.hpp"
#include "nodes/config/task_words.hpp"

namespace rtg::config {
namespace {

constexpr double kOffPin = 1e-3;    // largest legal gap of a joint in a start state
constexpr double kRounding = 1e-5;  // rounding error of values in single precision
constexpr double kLeastAxis = 1e-3;
constexpr double kUnitLength = 1e-12;  // an axis of this length, about 1, stays as it is

const std::vector<std::string> kJointKeys{"parent",   "child", "type",  "on_parent",
                                          "on_child", "axis",  "limits"};
constexpr std::array<std::string_view, 3> kTypes{"revolute", "prismatic", "fixed"};

std::string type_name(JointType type) {
  return std::string(kTypes[static_cast<std::size_t>(type)]);
}

int read_body_name(const FieldReader& reader, const char* key, const Scene& scene) {
  const std::string name = name_at(reader, key, "the name of a body");
  std::vector<std::string> names;
  for (std::size_t i = 1; i < scene.size(); ++i) {
    if (scene.bodies[i].name == name) return static_cast<int>(i);
    names.push_back(scene.bodies[i].name);
  }
  const bool is_robot = name == scene.bodies[0].name;
  throw ConfigError(
      reader.required(key, "").value.origin, reader.path(key),
      '\'' + name + "' is not the name of an object" +
          (is_robot ? " (joints connect objects, not the robot)" : suggestion(name, names)),
      listed(names));
}

[[noreturn]] void fail_at(const ConfigNode& section, std::size_t k, const char* key,
                          const std::string& wrong, const std::string& legal) {
  config::fail_at(find(section, "joints")->value.items[k], "task.joints." + std::to_string(k), key,
                  wrong, legal);
}

JointType read_type(const FieldReader& reader) {
  JointType type = JointType::kRevolute;
  FieldReader(reader).choice("type", type, kTypes);
  return type;
}

Vector2d read_axis(const FieldReader& reader) {
  const Vector2d axis = direction_at(reader, "axis");
  const double length = axis.norm();
  if (length < kLeastAxis)
    throw ConfigError(reader.required("axis", "").value.origin, reader.path("axis"),
                      "is no direction", "[x, y] in the parent's frame, not zero");
  return std::abs(length - 1.0) < kUnitLength ? axis : Vector2d(axis / length);
}

/// Throws ConfigError if a key belongs to joints of another type.
void check_keys(const ConfigNode& section, const std::string& path, JointType type) {
  const std::pair<const char*, bool> only_with[] = {{"on_parent", type == JointType::kRevolute},
                                                    {"on_child", type == JointType::kRevolute},
                                                    {"axis", type == JointType::kPrismatic},
                                                    {"limits", type != JointType::kFixed}};
  for (const auto& [key, is_legal] : only_with)
    if (find(section, key) && !is_legal)
      config::fail_at(section, path, key, "does not belong to a joint of type " + type_name(type),
                      type == JointType::kPrismatic ? "parent, child, type, axis, limits"
                      : type == JointType::kFixed   ? "parent, child, type"
                                                    : "parent, child, type, on_parent, on_child, "
                                                      "limits");
}

/// Throws ConfigError if a child is fixed, is the child of two joints, or is its own ancestor.
void check_tree(const Scene& scene, const ConfigNode& section) {
  for (std::size_t k = 0; k < scene.joints.size(); ++k) {
    const int child = scene.joints[k].child;
    const std::string name = '\'' + scene.bodies[static_cast<std::size_t>(child)].name + '\'';
    if (scene.bodies[static_cast<std::size_t>(child)].fixed)
      fail_at(section, k, "child", name + " is a fixed body", "a body that can move");
    int ancestor = scene.joints[k].parent;
    for (std::size_t n = 0; n <= scene.joints.size() && ancestor != child; ++n) {
      const auto up = std::ranges::find(scene.joints, ancestor, &Joint::child);
      if (up == scene.joints.end()) break;
      ancestor = up->parent;
    }
    if (ancestor == child)
      fail_at(section, k, "child", name + " would hang on itself through its joints",
              "joints that form trees");
    for (std::size_t n = 0; n < k; ++n)
      if (scene.joints[n].child == child)
        fail_at(section, k, "child", name + " is already the child of joint " + std::to_string(n),
                "joints that form trees");
  }
}

/// Throws ConfigError if a joint is open in the start state or has a value beyond its limits.
void check_start(const tasks::Task& task, const ConfigNode& section) {
  for (std::size_t k = 0; k < task.scene.joints.size(); ++k) {
    const Joint& joint = task.scene.joints[k];
    const auto child = static_cast<std::size_t>(joint.child);
    if (const double gap = joint_gap(joint, task.start); !(gap <= kOffPin)) {
      const Vector2d pin =
          to_world(task.start[static_cast<std::size_t>(joint.parent)], joint.on_parent);
      const Vector2d at = pin - rotate(task.start[child].theta, joint.on_child);
      fail_at(section, k, "on_child",
              "is " + length_text(std::round(1e4 * gap) / 1e4, task.units) +
                  " m away from on_parent in the start state",
              "'" + task.scene.bodies[child].name + "' at [" +
                  single_length_text(at.x(), task.units) + ", " +
                  single_length_text(at.y(), task.units) + "] in the start state, within " +
                  length_text(kOffPin, task.units) + " m");
    }
    const double value = joint_value(joint, task.start);
    const bool slides = joint.type == JointType::kPrismatic;
    const std::string unit = slides ? "m" : "rad";
    if (value < joint.lower - kRounding || value > joint.upper + kRounding)
      fail_at(section, k, "limits",
              (slides ? "exclude the joint's place in the start state, "
                      : "exclude the joint's angle in the start state, ") +
                  (slides ? single_length_text(value, task.units)
                          : single_text(static_cast<float>(value))) +
                  ' ' + unit,
              "[least, most] in " + unit + " that include it");
  }
}

}  // namespace

Joint read_joint(const ConfigNode& section, const std::string& path, const tasks::Task& task) {
  const FieldReader reader(section, path, kJointKeys, task.units);
  Joint joint;
  joint.parent = read_body_name(reader, "parent", task.scene);
  joint.child = read_body_name(reader, "child", task.scene);
  if (find(section, "type")) joint.type = read_type(reader);
  check_keys(section, path, joint.type);
  if (joint.type == JointType::kRevolute) {
    joint.on_parent = point_at(reader, "on_parent");
    joint.on_child = point_at(reader, "on_child");
  } else {
    const Pose& parent = task.start[static_cast<std::size_t>(joint.parent)];
    const Pose& child = task.start[static_cast<std::size_t>(joint.child)];
    joint.on_parent = to_local(parent, child.position());
    joint.angle = child.theta - parent.theta;
  }
  if (joint.type == JointType::kPrismatic) joint.axis = read_axis(reader);
  if (find(section, "limits")) {
    const bool slides = joint.type == JointType::kPrismatic;
    const Vector2d limits = slides ? lengths_at(reader, "limits") : angles_at(reader, "limits");
    joint.lower = limits[0];
    joint.upper = limits[1];
  }
  return joint;
}

ConfigNode joint_node(const Joint& joint, const tasks::Task& task) {
  const auto name = [&task](int body) {
    return text_node(task.scene.bodies[static_cast<std::size_t>(body)].name);
  };
  ConfigNode node = map_node();
  node.entries.push_back({"parent", "", name(joint.parent)});
  node.entries.push_back({"child", "", name(joint.child)});
  node.entries.push_back({"type", "", text_node(type_name(joint.type))});
  if (joint.type == JointType::kRevolute) {
    node.entries.push_back({"on_parent", "", point_node(joint.on_parent, task.units)});
    node.entries.push_back({"on_child", "", point_node(joint.on_child, task.units)});
  }
  if (joint.type == JointType::kPrismatic)
    node.entries.push_back({"axis", "", numbers_node({joint.axis.x(), joint.axis.y()})});
  const std::vector<double> limits{joint.lower, joint.upper};
  if (std::isfinite(joint.lower))
    node.entries.push_back({"limits", "",
                            joint.type == JointType::kPrismatic ? lengths_node(limits, task.units)
                                                                : numbers_node(limits)});
  return node;
}

void close_joints(tasks::Task& task, const ConfigNode& section) {
  if (task.scene.joints.empty()) return;
  check_tree(task.scene, section);
  check_start(task, section);
  task.start = with_closed_joints(task.scene, std::move(task.start));
  task.start = to_single(std::move(task.start));
}

}  // namespace rtg::config

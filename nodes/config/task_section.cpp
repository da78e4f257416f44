#include "nodes/config/task_section.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "nodes/config/config_error.hpp"
#include "nodes/config/field_reader.hpp"
#include "nodes/config/field_writer.hpp"
#include "nodes/config/goal_section.hpp"
#include "nodes/config/joint_section.hpp"
#include "nodes/config/shape_section.hpp"
#include "nodes/config/start_section.hpp"
#include "nodes/config/task_checks.hpp"
#include "nodes/config/task_words.hpp"
#include "nodes/config/units_section.hpp"

namespace rtg::config {
namespace {

using tasks::Units;
using Kind = ConfigNode::Kind;

constexpr std::size_t kMaxBodies = 32;
constexpr std::size_t kMaxTerms = 32;
constexpr std::size_t kMaxStrides = 8;
constexpr double kLeastStride = 0.01, kLongestStride = 100.0;
constexpr double kLeastDensity = 1e-3, kMostDensity = 1e3;  // as a multiple of the robot's

const std::vector<std::string> kBodyKeys{"name",     "kind",  "shape", "density",
                                         "friction", "fixed", "start"};

const std::vector<std::string> kPushKeys{"headings", "strides", "stride", "arena"};

/// The default is the density of the robot.
double read_density(const FieldReader& reader, const Units& units) {
  double density = units.density;
  if (const ConfigEntry* given = find(reader.section(), "density"))
    density = read_number(given->value, reader.path("density"), kLeastDensity * units.density,
                          kMostDensity * units.density, "kg/m²");
  return units.density_of(density);
}

/// Reads a body and adds its start to those of the task.
Body read_body(const ConfigNode& section, const std::string& path, tasks::Task& task) {
  FieldReader reader(section, path, kBodyKeys, task.units);
  Body body;
  body.name = name_at(reader, "name", kNameLegal);
  body.kind = name_at(reader, "kind", kNameLegal);
  const std::string shape_legal = "box, regular, vertices, disc or parts";
  body.shape =
      read_shape(reader.required("shape", shape_legal).value, reader.path("shape"), task.units);
  body.density = read_density(reader, task.units);
  reader.number("friction", body.friction, 0.0, 10.0);
  reader.flag("fixed", body.fixed);
  Start start = read_start(reader, task.start.empty());
  if (start.range && body.fixed)
    throw ConfigError(find(section, "start")->value.origin, reader.path("start"),
                      "is a range, but the body is fixed", "[x, y, theta] in m and rad");
  task.start.push_back(start.pose);
  task.start_ranges.push_back(std::move(start.range));
  return body;
}

/// Returns the list `key`, which must have `least` to `most` entries.
const ConfigNode& list_at(const FieldReader& reader, const char* key, std::size_t least,
                          std::size_t most) {
  const std::string legal =
      "a list of " + std::to_string(least) + " to " + std::to_string(most) + " entries";
  const ConfigNode& list = reader.required(key, legal).value;
  if (list.kind != Kind::kList)
    throw ConfigError(list.origin, reader.path(key), in_words(list) + " is not a list", legal);
  if (list.items.size() < least || list.items.size() > most)
    throw ConfigError(list.origin, reader.path(key),
                      "has " + std::to_string(list.items.size()) + " entries", legal);
  return list;
}

/// Reads the key `strides`, a list of lengths, or `stride`, one length.
std::vector<double> read_strides(const FieldReader& reader) {
  const ConfigNode& section = reader.section();
  const ConfigEntry *one = find(section, "stride"), *all = find(section, "strides");
  if (one && all)
    throw ConfigError(one->value.origin, reader.path("stride"), "is given beside strides",
                      "strides, a list of lengths in m, or stride, one length in m");
  const auto read = [&](const ConfigNode& node, const char* key) {
    return read_length(node, reader.path(key), kLeastStride, kLongestStride, reader.units());
  };
  if (one) return {read(one->value, "stride")};
  if (!all) return PushConfig{}.strides;
  const ConfigNode& list = list_at(reader, "strides", 1, kMaxStrides);
  std::vector<double> strides;
  for (const ConfigNode& item : list.items) {
    strides.push_back(read(item, "strides"));
    if (std::ranges::count(strides, strides.back()) > 1)
      throw ConfigError(item.origin, reader.path("strides"), item.scalar + " is given twice",
                        "lengths in m that differ");
  }
  return strides;
}

PushConfig read_push(const ConfigNode& section, const Units& units) {
  PushConfig push;
  FieldReader reader(section, "task.push", kPushKeys, units);
  push.visit(reader);
  push.strides = read_strides(reader);
  return push;
}

ConfigNode push_node(const PushConfig& push, const Units& units) {
  ConfigNode node = fields_of(push, units);
  node.entries.insert(node.entries.begin() + 1,
                      {"strides", "", lengths_node(push.strides, units),
                       "lengths of a push [m]; " + length_text(kLeastStride, units) + " to " +
                           length_text(kLongestStride, units)});
  return node;
}

ConfigNode body_node(const tasks::Task& task, std::size_t i) {
  const Body& body = task.scene.bodies[i];
  const bool ranges = !task.start_ranges.empty();
  ConfigNode node = map_node();
  const auto add = [&node](const char* key, ConfigNode value) {
    node.entries.push_back({key, "", std::move(value)});
  };
  add("name", text_node(body.name));
  add("kind", text_node(body.kind));
  add("shape", shape_node(body.shape, task.units));
  add("density", token_node(i == 0 ? number_text(task.units.density)
                                   : density_text(body.density, task.units)));
  add("friction", token_node(number_text(body.friction)));
  add("fixed", token_node(body.fixed ? "true" : "false"));
  add("start", start_node((ranges ? task.layout : task.start)[i],
                          ranges ? task.start_ranges[i] : std::nullopt, task.units));
  return node;
}

}  // namespace

tasks::Task read_task(const ConfigNode& section) {
  std::vector<std::string> keys{"name", "scale", "bodies", "joints", "goal", "push"};
  tasks::Task task;
  for (const ConfigEntry& field : fields_of(task).entries) keys.push_back(field.key);
  const FieldReader names(section, "task", keys);
  task.name = name_at(names, "name", kNameLegal);
  const ConfigNode& bodies = list_at(names, "bodies", 2, kMaxBodies);
  task.units = read_units(names, bodies.items[0]);
  FieldReader reader(section, "task", keys, task.units);
  for (std::size_t i = 0; i < bodies.items.size(); ++i)
    task.scene.bodies.push_back(
        read_body(bodies.items[i], "task.bodies." + std::to_string(i), task));
  if (std::ranges::none_of(task.start_ranges, &std::optional<tasks::StartRange>::has_value))
    task.start_ranges.clear();
  check_names(task, section);
  if (find(section, "joints")) {
    const ConfigNode& joints = list_at(reader, "joints", 0, kMaxBodies);
    for (std::size_t i = 0; i < joints.items.size(); ++i)
      task.scene.joints.push_back(
          read_joint(joints.items[i], "task.joints." + std::to_string(i), task));
  }
  const ConfigNode& goal = list_at(reader, "goal", 1, kMaxTerms);
  for (std::size_t i = 0; i < goal.items.size(); ++i)
    task.goal.push_back(read_term(goal.items[i], "task.goal." + std::to_string(i), task.units));
  if (const ConfigEntry* push = find(section, "push"))
    task.push = read_push(push->value, task.units);
  task.visit(reader);
  check_terms(task, section);  // a kind without bodies would hold anywhere, also at all starts
  close_joints(task, section);
  draw_nominal_start(task, section);
  check_task(task, section);
  return task;
}

ConfigNode task_node(tasks::Task task) {
  ConfigNode node = map_node();
  std::vector<ConfigNode> bodies, joints, goal;
  for (std::size_t i = 0; i < task.scene.size(); ++i) bodies.push_back(body_node(task, i));
  for (const Joint& joint : task.scene.joints) joints.push_back(joint_node(joint, task));
  for (const tasks::GoalTerm& term : task.goal) goal.push_back(term_node(term, task.units));
  node.entries.push_back({"name", "", text_node(task.name)});
  node.entries.push_back({"scale", "", token_node(scale_text(task.units)),
                          "radius of the robot, to which the constants of the solver fit [m]"});
  node.entries.push_back({"bodies", "", list_node(std::move(bodies)), "the first is the robot"});
  if (!joints.empty()) node.entries.push_back({"joints", "", list_node(std::move(joints))});
  node.entries.push_back({"goal", "", list_node(std::move(goal)), "all terms must hold"});
  node.entries.push_back({"push", "", push_node(task.push, task.units)});
  for (ConfigEntry& field : fields_of(task, task.units).entries)
    node.entries.push_back(std::move(field));
  return node;
}

}  // namespace rtg::config

#include "nodes/config/task_section.hpp"

#include <utility>
#include <vector>

#include "nodes/config/config_error.hpp"
#include "nodes/config/field_reader.hpp"
#include "nodes/config/field_writer.hpp"
#include "nodes/config/goal_section.hpp"
#include "nodes/config/joint_section.hpp"
#include "nodes/config/shape_section.hpp"
#include "nodes/config/task_checks.hpp"
#include "nodes/config/task_words.hpp"

namespace rtg::config {
namespace {

using Kind = ConfigNode::Kind;

constexpr std::size_t kMaxBodies = 32;
constexpr std::size_t kMaxTerms = 32;

const std::vector<std::string> kBodyKeys{"name",     "kind",  "shape", "density",
                                         "friction", "fixed", "start"};

Body read_body(const ConfigNode& section, const std::string& path, Poses& start) {
  FieldReader reader(section, path, kBodyKeys);
  Body body;
  body.name = name_at(reader, "name", kNameLegal);
  body.kind = name_at(reader, "kind", kNameLegal);
  const std::string shape_legal = "box, regular, vertices, disc or parts";
  body.shape = read_shape(reader.required("shape", shape_legal).value, reader.path("shape"));
  reader.number("density", body.density, 1e-3, 1e3);
  reader.number("friction", body.friction, 0.0, 10.0);
  reader.flag("fixed", body.fixed);
  const auto pose = reader.numbers("start", 3, -kMaxPlace, kMaxPlace, "[x, y, theta] in m and rad");
  start.push_back(to_single({pose[0], pose[1], pose[2]}));
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

/// Returns a node with the shortest number that single precision reads back as `single`.
ConfigNode single_node(double single) {
  return token_node(single_text(static_cast<float>(single)));
}

ConfigNode body_node(const Body& body, const Pose& start) {
  ConfigNode node = map_node();
  const auto add = [&node](const char* key, ConfigNode value) {
    node.entries.push_back({key, "", std::move(value)});
  };
  add("name", text_node(body.name));
  add("kind", text_node(body.kind));
  add("shape", shape_node(body.shape));
  add("density", token_node(number_text(body.density)));
  add("friction", token_node(number_text(body.friction)));
  add("fixed", token_node(body.fixed ? "true" : "false"));
  add("start", list_node({single_node(start.x), single_node(start.y), single_node(start.theta)}));
  return node;
}

}  // namespace

tasks::Task read_task(const ConfigNode& section) {
  std::vector<std::string> keys{"name", "bodies", "joints", "goal", "push"};
  tasks::Task task;
  for (const ConfigEntry& field : fields_of(task).entries) keys.push_back(field.key);
  FieldReader reader(section, "task", keys);
  task.name = name_at(reader, "name", kNameLegal);
  const ConfigNode& bodies = list_at(reader, "bodies", 2, kMaxBodies);
  for (std::size_t i = 0; i < bodies.items.size(); ++i)
    task.scene.bodies.push_back(
        read_body(bodies.items[i], "task.bodies." + std::to_string(i), task.start));
  check_names(task, section);
  if (find(section, "joints")) {
    const ConfigNode& joints = list_at(reader, "joints", 0, kMaxBodies);
    for (std::size_t i = 0; i < joints.items.size(); ++i)
      task.scene.joints.push_back(
          read_joint(joints.items[i], "task.joints." + std::to_string(i), task.scene));
  }
  const ConfigNode& goal = list_at(reader, "goal", 1, kMaxTerms);
  for (std::size_t i = 0; i < goal.items.size(); ++i)
    task.goal.push_back(read_term(goal.items[i], "task.goal." + std::to_string(i)));
  if (const ConfigEntry* push = find(section, "push"))
    read_fields(push->value, "task.push", task.push);
  task.visit(reader);
  close_joints(task, section);
  check_task(task, section);
  return task;
}

ConfigNode task_node(tasks::Task task) {
  ConfigNode node = map_node();
  std::vector<ConfigNode> bodies, joints, goal;
  for (std::size_t i = 0; i < task.scene.size(); ++i)
    bodies.push_back(body_node(task.scene.bodies[i], task.start[i]));
  for (const Joint& joint : task.scene.joints) joints.push_back(joint_node(joint, task.scene));
  for (const tasks::GoalTerm& term : task.goal) goal.push_back(term_node(term));
  node.entries.push_back({"name", "", text_node(task.name)});
  node.entries.push_back({"bodies", "", list_node(std::move(bodies)), "the first is the robot"});
  if (!joints.empty()) node.entries.push_back({"joints", "", list_node(std::move(joints))});
  node.entries.push_back({"goal", "", list_node(std::move(goal)), "all terms must hold"});
  node.entries.push_back({"push", "", fields_of(task.push)});
  for (ConfigEntry& field : fields_of(task).entries) node.entries.push_back(std::move(field));
  return node;
}

}  // namespace rtg::config

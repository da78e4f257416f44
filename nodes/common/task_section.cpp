#include "nodes/common/task_section.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "nodes/common/config_error.hpp"
#include "nodes/common/field_reader.hpp"
#include "nodes/common/field_writer.hpp"
#include "nodes/common/shape_section.hpp"
#include "nodes/common/task_checks.hpp"

namespace rtg {
namespace {

using Kind = ConfigNode::Kind;

constexpr std::size_t kMaxBodies = 32;
constexpr std::size_t kMaxTerms = 32;
constexpr std::size_t kMaxName = 40;  // characters
constexpr double kMaxPlace = 1000.0;  // |x|, |y|, |θ| of a start pose
constexpr double kUnitWithin = 1e-6;  // of the length of a normal

const std::vector<std::string> kBodyKeys{"name",     "kind",  "shape", "density",
                                         "friction", "fixed", "start"};
const std::vector<std::string> kTermKeys{"kind", "disc", "half_plane"};
const std::vector<std::string> kDiscKeys{"centre", "radius"};
const std::vector<std::string> kHalfPlaneKeys{"normal", "offset"};
const std::string kNameLegal = "a letter, then letters, digits, _ and -, 40 at most";
const std::string kTermLegal =
    "{kind: word, disc: {centre: [x, y], radius: m}} or "
    "{kind: word, half_plane: {normal: [x, y], offset: m}}";

std::string name_at(const FieldReader& reader, const char* key, const std::string& legal) {
  const ConfigNode& node = reader.required(key, legal).value;
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const auto is_legal = [&](char c) {
    return is_letter(c) || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  const std::string& name = node.scalar;
  if (node.kind != Kind::kScalar || name.empty() || name.size() > kMaxName || !is_letter(name[0]) ||
      !std::all_of(name.begin(), name.end(), is_legal))
    throw ConfigError(node.origin, reader.path(key), in_words(node) + " is no name", legal);
  return name;
}

Body read_body(const ConfigNode& section, const std::string& path, Poses& start) {
  FieldReader reader(section, path, kBodyKeys);
  Body body;
  body.name = name_at(reader, "name", kNameLegal);
  body.kind = name_at(reader, "kind", kNameLegal);
  const std::string shape_legal = "box, regular or vertices";
  body.shape = read_shape(reader.required("shape", shape_legal).value, reader.path("shape"));
  reader.number("density", body.density, 1e-3, 1e3);
  reader.number("friction", body.friction, 0.0, 10.0);
  reader.flag("fixed", body.fixed);
  const auto pose = reader.numbers("start", 3, -kMaxPlace, kMaxPlace, "[x, y, theta] in m and rad");
  start.push_back(to_single({pose[0], pose[1], pose[2]}));
  return body;
}

Vector2d read_point(const FieldReader& reader, const char* key) {
  const auto x = reader.numbers(key, 2, -kMaxPlace, kMaxPlace, "[x, y]");
  return {x[0], x[1]};
}

void read_disc(const ConfigNode& section, const std::string& path, GoalTerm& term) {
  FieldReader reader(section, path, kDiscKeys);
  term.region = GoalTerm::Region::kDisc;
  term.centre = read_point(reader, "centre");
  reader.required("radius", "a number from 0.1 to 1000.0 [m]");
  reader.number("radius", term.radius, 0.1, kMaxPlace);
}

void read_half_plane(const ConfigNode& section, const std::string& path, GoalTerm& term) {
  FieldReader reader(section, path, kHalfPlaneKeys);
  term.region = GoalTerm::Region::kHalfPlane;
  term.normal = read_point(reader, "normal");
  const double length = term.normal.norm();
  if (std::abs(length - 1.0) > kUnitWithin)
    throw ConfigError(find(section, "normal")->value.origin, reader.path("normal"),
                      "has length " + number_text(length), "[x, y] of length 1");
  reader.required("offset", "a number, largest normal . x [m]");
  reader.number("offset", term.offset, -kMaxPlace, kMaxPlace);
}

GoalTerm read_term(const ConfigNode& section, const std::string& path) {
  const FieldReader reader(section, path, kTermKeys);
  const ConfigEntry *kind = find(section, "kind"), *disc = find(section, "disc"),
                    *half_plane = find(section, "half_plane");
  if (!disc == !half_plane)
    throw ConfigError(section.origin, path, disc ? "has two regions" : "has no region", kTermLegal);
  GoalTerm term;
  if (kind && kind->value.scalar != "*")
    term.kind = name_at(reader, "kind", "the kind of a body, or \"*\" for all objects");
  if (disc)
    read_disc(disc->value, reader.path("disc"), term);
  else
    read_half_plane(half_plane->value, reader.path("half_plane"), term);
  return term;
}

/// The list `key`, with between `least` and `most` entries.
const ConfigNode& list_at(const FieldReader& reader, const char* key, std::size_t least,
                          std::size_t most) {
  const std::string legal =
      "a list of " + std::to_string(least) + " to " + std::to_string(most) + " entries";
  const ConfigNode& list = reader.required(key, legal).value;
  if (list.kind != Kind::kList)
    throw ConfigError(list.origin, reader.path(key), "is " + in_words(list), legal);
  if (list.items.size() < least || list.items.size() > most)
    throw ConfigError(list.origin, reader.path(key),
                      "has " + std::to_string(list.items.size()) + " entries", legal);
  return list;
}

/// The shortest number that rounds to that single.
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

ConfigNode term_node(const GoalTerm& term) {
  const bool is_disc = term.region == GoalTerm::Region::kDisc;
  const Vector2d& point = is_disc ? term.centre : term.normal;
  ConfigNode region = map_node();
  region.entries.push_back(
      {is_disc ? "centre" : "normal", "",
       list_node({token_node(number_text(point.x())), token_node(number_text(point.y()))})});
  region.entries.push_back({is_disc ? "radius" : "offset", "",
                            token_node(number_text(is_disc ? term.radius : term.offset))});
  ConfigNode node = map_node();
  node.entries.push_back({"kind", "", text_node(term.kind)});
  node.entries.push_back({is_disc ? "disc" : "half_plane", "", std::move(region)});
  return node;
}

}  // namespace

Task read_task(const ConfigNode& section) {
  std::vector<std::string> keys{"name", "bodies", "goal", "push"};
  Task task;
  for (const ConfigEntry& field : fields_of(task).entries) keys.push_back(field.key);
  FieldReader reader(section, "task", keys);
  task.name = name_at(reader, "name", kNameLegal);
  const ConfigNode& bodies = list_at(reader, "bodies", 2, kMaxBodies);
  for (std::size_t i = 0; i < bodies.items.size(); ++i)
    task.scene.bodies.push_back(
        read_body(bodies.items[i], "task.bodies." + std::to_string(i), task.start));
  const ConfigNode& goal = list_at(reader, "goal", 1, kMaxTerms);
  for (std::size_t i = 0; i < goal.items.size(); ++i)
    task.goal.push_back(read_term(goal.items[i], "task.goal." + std::to_string(i)));
  if (const ConfigEntry* push = find(section, "push"))
    read_fields(push->value, "task.push", task.push);
  task.visit(reader);
  check_task(task, section);
  return task;
}

ConfigNode task_node(Task task) {
  ConfigNode node = map_node();
  std::vector<ConfigNode> bodies, goal;
  for (std::size_t i = 0; i < task.scene.size(); ++i)
    bodies.push_back(body_node(task.scene.bodies[i], task.start[i]));
  for (const GoalTerm& term : task.goal) goal.push_back(term_node(term));
  node.entries.push_back({"name", "", text_node(task.name)});
  node.entries.push_back({"bodies", "", list_node(std::move(bodies)), "the first is the robot"});
  node.entries.push_back({"goal", "", list_node(std::move(goal)), "all must hold"});
  node.entries.push_back({"push", "", fields_of(task.push)});
  for (ConfigEntry& field : fields_of(task).entries) node.entries.push_back(std::move(field));
  return node;
}

}  // namespace rtg

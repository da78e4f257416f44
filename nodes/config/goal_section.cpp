#include "nodes/config/goal_section.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "nodes/config/config_error.hpp"
#include "nodes/config/field_reader.hpp"
#include "nodes/config/region_section.hpp"
#include "nodes/config/task_words.hpp"

namespace rtg::config {
namespace {

using namespace tasks;

constexpr double kLeastLength = 0.01;  // least tolerance of a length
constexpr double kLeastGap = 0.03;     // bodies that touch rest up to 0.02 apart
constexpr double kLeastTurn = 0.01;    // least tolerance of an angle [rad]

const std::vector<std::string> kSubjects{"kind", "centroid", "joint"};
const std::vector<std::string> kConditions{"disc",  "half_plane", "box",    "polygon",
                                           "angle", "pose",       "covers", "touching",
                                           "apart", "stays",      "angles", "slides"};
const std::vector<std::string> kTermKeys{
    "kind",   "centroid", "joint", "disc",  "half_plane", "box",    "polygon", "angle", "pose",
    "covers", "touching", "apart", "stays", "angles",     "slides", "within",  "gap",   "not"};
const std::vector<std::string> kCoversKeys{"at", "share"};
const std::string kTermLegal =
    "one of the conditions disc, half_plane, box, polygon (of a kind or a centroid), angle, pose, "
    "covers, touching, apart, stays (of a kind), angles or slides (of a joint)";

const std::string kPoseLegal = "[x, y, theta] in m and rad";

std::string metres(double length, const FieldReader& reader) {
  return length_text(length, reader.units());
}

PoseNear read_pose(const FieldReader& reader) {
  const std::string legal = "[distance, turn] in m and rad, " + metres(kLeastLength, reader) +
                            " m and " + number_text(kLeastTurn) + " rad or more";
  const std::vector<ConfigNode>& within = reader.items("within", 2, legal);
  const std::string path = reader.path("within");
  return {reader.pose("pose", kMaxPlace, kPoseLegal),
          read_length(within[0], path, kLeastLength, kMaxPlace, reader.units()),
          read_number(within[1], path, kLeastTurn, kMaxPlace, "rad")};
}

Covers read_covers(const ConfigNode& section, const std::string& path, const Units& units) {
  FieldReader reader(section, path, kCoversKeys, units);
  Covers covers{reader.pose("at", kMaxPlace, kPoseLegal), 0.0};
  reader.required("share", "a number from 0.01 to 0.99");
  reader.number("share", covers.share, 0.01, 0.99);
  return covers;
}

double gap_at(FieldReader& reader) {
  double gap = 0.0;
  reader.required("gap", length_range(kLeastGap, kMaxPlace, reader.units()));
  reader.length("gap", gap, kLeastGap, kMaxPlace);
  return gap;
}

std::string other_kind(const FieldReader& reader, const char* key) {
  const std::string legal = "the kind of a body, or \"*\" for all objects";
  return reader.required(key, legal).value.scalar == "*" ? "*" : name_at(reader, key, legal);
}

Condition read_condition(FieldReader& reader, const ConfigEntry& entry, bool of_mean) {
  const std::string& key = entry.key;
  if (key == "angle") {
    const Vector2d range = angles_at(reader, "angle");
    return AngleIn{range[0], range[1]};
  }
  if (key == "angles") {
    const Vector2d range = angles_at(reader, "angles");
    return JointIn{range[0], range[1], JointType::kRevolute};
  }
  if (key == "slides") {
    const Vector2d range = lengths_at(reader, "slides");
    return JointIn{range[0], range[1], JointType::kPrismatic};
  }
  if (key == "pose") return read_pose(reader);
  if (key == "covers") return read_covers(entry.value, reader.path(key), reader.units());
  if (key == "touching") return Touches{other_kind(reader, "touching"), gap_at(reader)};
  if (key == "apart") return KeepsFrom{other_kind(reader, "apart"), gap_at(reader)};
  if (key == "stays") {
    Stays stays;
    reader.length("stays", stays.distance, kLeastLength, kMaxPlace);
    return stays;
  }
  Region region = read_region(reader, entry);
  if (of_mean) return MeanIn{std::move(region)};
  return CentreIn{std::move(region)};
}

/// Returns the only entry of `section` with a key among `keys`; null if there is none. Throws
/// ConfigError if there are several.
const ConfigEntry* only_of(const ConfigNode& section, const std::vector<std::string>& keys,
                           const std::string& path) {
  const ConfigEntry* only = nullptr;
  for (const std::string& key : keys) {
    const ConfigEntry* entry = find(section, key);
    if (entry && only)
      throw ConfigError(section.origin, path, "has both of the keys " + only->key + " and " + key,
                        "one of " + listed(keys));
    if (entry) only = entry;
  }
  return only;
}

/// Throws ConfigError if the condition is none of this subject, or if a key belongs to another
/// condition.
void check_keys(const ConfigNode& section, const std::string& path, const std::string& subject,
                const std::string& condition) {
  const bool is_region = condition == "disc" || condition == "half_plane" || condition == "box" ||
                         condition == "polygon";
  const bool of_joint = condition == "angles" || condition == "slides";
  if ((subject == "joint") != of_joint)
    throw ConfigError(section.origin, path,
                      of_joint ? "has the key " + condition + " without the key joint"
                               : "has the key joint without the keys angles or slides",
                      kTermLegal);
  if (subject == "centroid" && !is_region)
    throw ConfigError(section.origin, path, "has the key " + condition + " of a centroid",
                      kTermLegal);
  const std::pair<const char*, bool> only_with[] = {
      {"within", condition == "pose"}, {"gap", condition == "touching" || condition == "apart"}};
  for (const auto& [key, is_legal] : only_with)
    if (const ConfigEntry* entry = find(section, key); entry && !is_legal)
      throw ConfigError(
          entry->value.origin, path + '.' + key, "does not belong to the condition " + condition,
          std::string(key) == "gap" ? "gap with touching or apart" : "within with pose");
}

/// Writers of the entries of a condition.
struct ConditionWriter {
  std::vector<ConfigEntry>& to;
  const Units& units;

  void operator()(const CentreIn& c) const { to.push_back(region_entry(c.region, units)); }
  void operator()(const MeanIn& c) const { to.push_back(region_entry(c.region, units)); }
  void operator()(const AngleIn& c) const {
    to.push_back({"angle", "", numbers_node({c.least, c.most})});
  }
  void operator()(const JointIn& c) const {
    if (c.type == JointType::kPrismatic)
      to.push_back({"slides", "", lengths_node({c.least, c.most}, units)});
    else
      to.push_back({"angles", "", numbers_node({c.least, c.most})});
  }
  void operator()(const PoseNear& c) const {
    to.push_back({"pose", "", pose_node(c.pose, units)});
    to.push_back({"within", "",
                  list_node({length_node(c.distance, units), token_node(number_text(c.turn))})});
  }
  void operator()(const Covers& c) const {
    to.push_back({"covers", "",
                  mapping({{"at", "", pose_node(c.pose, units)},
                           {"share", "", token_node(number_text(c.share))}})});
  }
  void operator()(const Touches& c) const { add_gap("touching", c.other, c.gap); }
  void operator()(const KeepsFrom& c) const { add_gap("apart", c.other, c.gap); }
  void operator()(const Stays& c) const {
    to.push_back({"stays", "", length_node(c.distance, units)});
  }

 private:
  void add_gap(const char* key, const std::string& other, double gap) const {
    to.push_back({key, "", text_node(other)});
    to.push_back({"gap", "", length_node(gap, units)});
  }
};

}  // namespace

GoalTerm read_term(const ConfigNode& section, const std::string& path, const Units& units) {
  FieldReader reader(section, path, kTermKeys, units);
  const ConfigEntry* subject = only_of(section, kSubjects, path);
  const ConfigEntry* condition = only_of(section, kConditions, path);
  if (!condition) throw ConfigError(section.origin, path, "has no condition", kTermLegal);
  const std::string of = subject ? subject->key : "kind";
  check_keys(section, path, of, condition->key);
  GoalTerm term;
  if (subject && subject->value.scalar != "*")
    term.kind = name_at(reader, of.c_str(),
                        of == "joint" ? "the child of a joint, or \"*\" for all joints"
                                      : "the kind of a body, or \"*\" for all objects");
  term.condition = read_condition(reader, *condition, of == "centroid");
  reader.flag("not", term.negated);
  return term;
}

ConfigNode term_node(const GoalTerm& term, const Units& units) {
  ConfigNode node = map_node();
  const char* subject = std::holds_alternative<JointIn>(term.condition)  ? "joint"
                        : std::holds_alternative<MeanIn>(term.condition) ? "centroid"
                                                                         : "kind";
  node.entries.push_back({subject, "", text_node(term.kind)});
  std::visit(ConditionWriter{node.entries, units}, term.condition);
  if (term.negated) node.entries.push_back({"not", "", token_node("true")});
  return node;
}

}  // namespace rtg::config

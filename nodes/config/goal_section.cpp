#include "nodes/config/goal_section.hpp"

#include <cmath>

#include "nodes/config/config_error.hpp"
#include "nodes/config/field_reader.hpp"
#include "nodes/config/task_words.hpp"

namespace rtg::config {
namespace {

constexpr double kUnitWithin = 1e-2;    // legal error of a normal's length, as of [0.71, 0.71]
constexpr double kUnitExactly = 1e-12;  // error of the length that is not corrected

const std::vector<std::string> kTermKeys{"kind", "centroid",   "joint",
                                         "disc", "half_plane", "angles"};
const std::vector<std::string> kDiscKeys{"centre", "radius"};
const std::vector<std::string> kHalfPlaneKeys{"normal", "offset"};
const std::string kTermLegal =
    "kind or centroid with disc: {centre: [x, y], radius: m} or half_plane: {normal: [x, y], "
    "offset: m}; joint with angles: [least, most]";

void read_disc(const ConfigNode& section, const std::string& path, tasks::GoalTerm& term) {
  FieldReader reader(section, path, kDiscKeys);
  term.region = tasks::GoalTerm::Region::kDisc;
  term.centre = point_at(reader, "centre");
  reader.required("radius", "a number from 0.1 to 1000.0 [m]");
  reader.number("radius", term.radius, 0.1, kMaxPlace);
}

void read_half_plane(const ConfigNode& section, const std::string& path, tasks::GoalTerm& term) {
  FieldReader reader(section, path, kHalfPlaneKeys);
  term.region = tasks::GoalTerm::Region::kHalfPlane;
  term.normal = point_at(reader, "normal");
  const double length = term.normal.norm();
  if (std::abs(length - 1.0) > kUnitWithin)
    throw ConfigError(find(section, "normal")->value.origin, reader.path("normal"),
                      "has length " + number_text(length), "[x, y] of length 1, within 0.01");
  if (std::abs(length - 1.0) > kUnitExactly) term.normal /= length;
  reader.required("offset", "a number, the largest normal . [x, y] in the half-plane [m]");
  reader.number("offset", term.offset, -kMaxPlace, kMaxPlace);
}

/// Reads what the term is about: key `kind` (the default), `centroid` or `joint`.
void read_subject(const FieldReader& reader, const std::string& path, tasks::GoalTerm& term) {
  const ConfigNode& section = reader.section();
  const bool of_joint = find(section, "joint"), of_centroid = find(section, "centroid");
  if (of_joint + of_centroid + (find(section, "kind") != nullptr) > 1)
    throw ConfigError(section.origin, path, "has more than one of the keys kind, centroid, joint",
                      kTermLegal);
  const char* key = of_joint ? "joint" : of_centroid ? "centroid" : "kind";
  term.subject = of_joint      ? tasks::GoalTerm::Subject::kJoint
                 : of_centroid ? tasks::GoalTerm::Subject::kCentroid
                               : tasks::GoalTerm::Subject::kEvery;
  const ConfigEntry* subject = find(section, key);
  if (subject && subject->value.scalar != "*")
    term.kind = name_at(reader, key,
                        of_joint ? "the child of a joint, or \"*\" for all joints"
                                 : "the kind of a body, or \"*\" for all objects");
}

ConfigNode region_node(const tasks::GoalTerm& term) {
  if (term.region == tasks::GoalTerm::Region::kAngles) return point_node({term.least, term.most});
  const bool is_disc = term.region == tasks::GoalTerm::Region::kDisc;
  ConfigNode region = map_node();
  region.entries.push_back(
      {is_disc ? "centre" : "normal", "", point_node(is_disc ? term.centre : term.normal)});
  region.entries.push_back({is_disc ? "radius" : "offset", "",
                            token_node(number_text(is_disc ? term.radius : term.offset))});
  return region;
}

}  // namespace

tasks::GoalTerm read_term(const ConfigNode& section, const std::string& path) {
  const FieldReader reader(section, path, kTermKeys);
  const ConfigEntry *disc = find(section, "disc"), *half_plane = find(section, "half_plane"),
                    *angles = find(section, "angles");
  const int regions = (disc != nullptr) + (half_plane != nullptr) + (angles != nullptr);
  if (regions != 1)
    throw ConfigError(section.origin, path,
                      regions ? "has more than one of the keys disc, half_plane, angles"
                              : "has none of the keys disc, half_plane, angles",
                      kTermLegal);
  tasks::GoalTerm term;
  read_subject(reader, path, term);
  if ((angles != nullptr) != (term.subject == tasks::GoalTerm::Subject::kJoint))
    throw ConfigError(section.origin, path,
                      angles ? "has the key angles without the key joint"
                             : "has the key joint without the key angles",
                      kTermLegal);
  if (disc) read_disc(disc->value, reader.path("disc"), term);
  if (half_plane) read_half_plane(half_plane->value, reader.path("half_plane"), term);
  if (angles) {
    const Vector2d range = angles_at(reader, "angles");
    term.region = tasks::GoalTerm::Region::kAngles;
    term.least = range[0];
    term.most = range[1];
  }
  return term;
}

ConfigNode term_node(const tasks::GoalTerm& term) {
  constexpr const char* kSubjects[] = {"kind", "centroid", "joint"};
  constexpr const char* kRegions[] = {"disc", "half_plane", "angles"};
  ConfigNode node = map_node();
  node.entries.push_back(
      {kSubjects[static_cast<std::size_t>(term.subject)], "", text_node(term.kind)});
  node.entries.push_back({kRegions[static_cast<std::size_t>(term.region)], "", region_node(term)});
  return node;
}

}  // namespace rtg::config

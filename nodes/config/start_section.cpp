#include "nodes/config/start_section.hpp"

#include <algorithm>
#include <numbers>
#include <utility>
#include <vector>

#include "core/world/separation.hpp"
#include "nodes/config/config_error.hpp"
#include "nodes/config/region_section.hpp"
#include "nodes/config/task_words.hpp"

namespace rtg::config {
namespace {

using tasks::Units;
using Kind = ConfigNode::Kind;

constexpr double kThin = 1e-6;  // least side of a range of places

const std::vector<std::string> kRangeKeys{"x", "y", "theta"};
const std::vector<std::string> kInKeys{"in", "theta"};
const std::vector<std::string> kRegions{"disc", "box", "polygon"};
const std::string kStartLegal =
    "[x, y, theta] in m and rad, {x: a, y: b, theta: c} with ranges [least, most] in the place of "
    "numbers, or {in: {disc, box or polygon}, theta: [least, most]}";

/// Reads a value, or a range of values, by read(node). `unit`: that of the values, for messages.
template <class Read>
std::pair<double, double> range_at(const FieldReader& reader, const char* key,
                                   const std::string& unit, Read read) {
  const std::string legal = "a number or [least, most] in " + unit;
  const ConfigNode& node = reader.required(key, legal).value;
  if (node.kind != Kind::kList) {
    const double value = read(node);
    return {value, value};
  }
  const std::vector<ConfigNode>& ends = reader.items(key, 2, legal);
  const std::pair range{read(ends[0]), read(ends[1])};
  if (range.first > range.second)
    throw ConfigError(node.origin, reader.path(key), ends[0].scalar + " is above " + ends[1].scalar,
                      "[least, most] with least at most most");
  return range;
}

std::pair<double, double> lengths_of(const FieldReader& reader, const char* key) {
  return range_at(reader, key, "m", [&](const ConfigNode& node) {
    return read_length(node, reader.path(key), -kMaxPlace, kMaxPlace, reader.units());
  });
}

std::pair<double, double> angles_of(const FieldReader& reader, const char* key) {
  return range_at(reader, key, "rad",
                  [&](const ConfigNode& node) { return read_angle(node, reader.path(key)); });
}

/// Returns the range of `theta`; any angle if it is not given, but 0 for the robot.
std::pair<double, double> angles_of(const FieldReader& reader, bool is_robot) {
  if (find(reader.section(), "theta")) return angles_of(reader, "theta");
  const double most = is_robot ? 0.0 : std::numbers::pi;
  return {-most, most};
}

/// Returns the rectangle between the ends, which are on the grid of the units, as its corners are:
/// so their text reads back to the bit.
Polygon rectangle(std::pair<double, double> x, std::pair<double, double> y, const Units& units) {
  for (auto* side : {&x, &y})
    if (side->second - side->first < kThin / 2.0) {  // what was made thin is read back as it is
      side->first = units.on_grid(side->first - kThin / 2.0);
      side->second = units.on_grid(side->second + kThin / 2.0);
    }
  return {{{x.first, y.first}, {x.second, y.first}, {x.second, y.second}, {x.first, y.second}}};
}

Start middle_of(tasks::StartRange range) {
  Vector2d sum = Vector2d::Zero();
  const std::vector<Vector2d> ring = ring_of(range.region, 0.0);
  for (const Vector2d& v : ring) sum += v / static_cast<double>(ring.size());
  return {to_single({sum.x(), sum.y(), (range.least + range.most) / 2.0}), std::move(range)};
}

Start read_region_start(const ConfigNode& section, const std::string& path, const Units& units,
                        bool is_robot) {
  const FieldReader reader(section, path, kInKeys, units);
  const ConfigNode& in = reader.required("in", "{disc, box or polygon}").value;
  const FieldReader region(in, reader.path("in"), kRegions, units);
  if (in.entries.size() != 1)
    throw ConfigError(in.origin, reader.path("in"),
                      "has " + std::to_string(in.entries.size()) + " regions",
                      "one of " + listed(kRegions));
  const auto angles = angles_of(reader, is_robot);
  return middle_of({read_region(region, in.entries[0]), angles.first, angles.second});
}

Start read_box_start(const ConfigNode& section, const std::string& path, const Units& units,
                     bool is_robot) {
  const FieldReader reader(section, path, kRangeKeys, units);
  const auto x = lengths_of(reader, "x"), y = lengths_of(reader, "y"),
             theta = angles_of(reader, is_robot);
  return middle_of({rectangle(x, y, units), theta.first, theta.second});
}

}  // namespace

Start read_start(const FieldReader& body, bool is_robot) {
  const ConfigNode& node = body.required("start", kStartLegal).value;
  const std::string path = body.path("start");
  if (node.kind == Kind::kMap)
    return find(node, "in") ? read_region_start(node, path, body.units(), is_robot)
                            : read_box_start(node, path, body.units(), is_robot);
  return {to_single(body.pose("start", kMaxPlace, kStartLegal)), std::nullopt};
}

ConfigNode start_node(const Pose& pose, const std::optional<tasks::StartRange>& range,
                      const Units& units) {
  if (!range)
    return list_node({token_node(single_length_text(pose.x, units)),
                      token_node(single_length_text(pose.y, units)),
                      token_node(single_text(static_cast<float>(pose.theta)))});
  if (const auto* polygon = std::get_if<Polygon>(&range->region); polygon && polygon->size() == 4) {
    const Vector2d &low = polygon->vertices[0], &high = polygon->vertices[2];
    const std::pair x{low.x(), high.x()}, y{low.y(), high.y()};
    if (*polygon == rectangle(x, y, units))
      return mapping({{"x", "", lengths_node({x.first, x.second}, units)},
                      {"y", "", lengths_node({y.first, y.second}, units)},
                      {"theta", "", numbers_node({range->least, range->most})}});
  }
  return mapping({{"in", "", mapping({region_entry(range->region, units)})},
                  {"theta", "", numbers_node({range->least, range->most})}});
}

namespace {

constexpr int kTries = 200;  // draws of a body from its range

/// Throws ConfigError if all places that body `i` is drawn from are out of the arena, or overlap
/// one fixed body.
void check_range(const tasks::Task& task, std::size_t i, const ConfigNode& section) {
  const auto fail = [&](const std::string& wrong, const std::string& legal) {
    fail_at(find(section, "bodies")->value.items[i], "task.bodies." + std::to_string(i), "start",
            "puts '" + task.scene.bodies[i].name + "' " + wrong + " in all of " +
                std::to_string(kTries) + " draws",
            legal);
  };
  Rng rng(1);
  int outside = 0;
  std::vector<int> overlaps(task.scene.size(), 0);
  for (int k = 0; k < kTries; ++k) {
    const Pose pose = drawn_from(*task.start_ranges[i], rng);
    outside += !in_arena(pose, task.push);
    for (std::size_t j = 0; j < task.scene.size(); ++j)
      overlaps[j] += task.scene.bodies[j].fixed &&
                     separation(task.scene.bodies[i].shape, pose, task.scene.bodies[j].shape,
                                task.start[j]) < tasks::kStartClearance;
  }
  const std::string arena = length_text(task.push.arena, task.units);
  if (outside == kTries)
    fail("out of the arena",
         "a range with x and y from -" + arena + " to " + arena + " m (task.push.arena)");
  for (std::size_t j = 0; j < task.scene.size(); ++j)
    if (overlaps[j] == kTries)
      fail("onto '" + task.scene.bodies[j].name + "'", "a range with room for the body");
}

}  // namespace

void draw_nominal_start(tasks::Task& task, const ConfigNode& section) {
  if (task.start_ranges.empty()) return;
  for (const Joint& joint : task.scene.joints) {
    const auto child = static_cast<std::size_t>(joint.child);
    if (task.start_ranges[child])
      fail_at(find(section, "bodies")->value.items[child], "task.bodies." + std::to_string(child),
              "start", "is a range, but the body hangs on a joint",
              "[x, y, theta] in m and rad, as if the first body of the tree were in the middle of "
              "its range");
  }
  Rng rng(1);
  task.layout = task.start;
  tasks::Refusals refusals;
  if (std::optional<Poses> start = drawn_start(task, 0.0, rng, &refusals)) {
    task.start = *std::move(start);
    return;
  }
  for (std::size_t i = 0; i < task.scene.size(); ++i)
    if (task.start_ranges[i]) check_range(task, i, section);
  throw ConfigError(
      find(section, "bodies")->value.origin, "task.bodies",
      "of 1000 states drawn from the starts none is legal; " + main_reason(refusals, task.scene),
      "starts in which bodies often lie " + length_text(tasks::kStartClearance, task.units) +
          " m apart, in the arena, with the goal not met");
}

}  // namespace rtg::config

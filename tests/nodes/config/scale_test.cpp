// A task of another size or mass is the same task.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "nodes/config/config.hpp"
#include "nodes/config/field_reader.hpp"
#include "nodes/config/yaml_parser.hpp"
#include "nodes/files/regular_file.hpp"
#include "tests/support/generation_run.hpp"

namespace rtg::config {
namespace {

/// Gathering with all lengths times `scale` and all densities times `density`.
std::string gathering(double scale, double density) {
  const auto m = [scale](double x) { return number_text(scale * x); };
  const auto body = [&](const std::string& name, const std::string& shape, double x, double y,
                        double theta) {
    return "    - {name: " + name + ", kind: " + (name == "robot" ? name : "box") +
           ", shape: " + shape + ", density: " + number_text(density) +
           ", friction: 0.5, start: [" + m(x) + ", " + m(y) + ", " + number_text(theta) + "]}\n";
  };
  const std::string box = "{box: [" + m(1.2) + ", " + m(1.2) + "]}";
  return "task:\n  name: gathering\n  bodies:\n" +
         body("robot", "{regular: {sides: 6, radius: " + m(0.8) + "}}", 0.0, -5.0, 0.0) +
         body("box1", box, -3.0, 1.13, 0.2) + body("box2", box, 2.63, 2.25, -0.3) +
         body("box3", box, 2.25, -2.25, 0.6) +
         "  goal:\n    - {disc: {centre: [0, 0], radius: " + m(2.0) +
         "}}\n  push: {headings: 48, stride: " + m(2.0) + ", arena: " + m(8.0) + "}\n";
}

Config parsed(double scale, double density) {
  return parse_config(gathering(scale, density), "gathering.yaml");
}

class Scale : public ::testing::TestWithParam<std::pair<double, double>> {};

// To the bit in units of the task; in metres to the rounding of single precision.
TEST_P(Scale, GivesTheSameTransitions) {
  const auto [scale, density] = GetParam();
  const Config one = parsed(1.0, 1.0), other = parsed(scale, density);
  EXPECT_NEAR(other.task.units.length, scale, 1e-12 * scale);
  EXPECT_EQ(other.task.units.density, density);
  EXPECT_EQ(other.task.scene.bodies, one.task.scene.bodies);
  EXPECT_EQ(other.task.start, one.task.start);
  EXPECT_EQ(task_hash(other.task), task_hash(one.task));
  search::SearchConfig search;
  search.transitions = 300;
  search.depth = 4;
  const auto generated = [&](const Config& config) {
    return testing::run(config.task, search, 7,
                        testing::seams_of(config.task, search::Generator::kRrbs, 1))
        .stored;
  };
  const std::vector<search::Transition> stored = generated(one);
  ASSERT_GE(stored.size(), 300u);
  EXPECT_EQ(generated(other), stored);
}

INSTANTIATE_TEST_SUITE_P(Scales, Scale,
                         ::testing::Values(std::pair{0.05, 1.0}, std::pair{50.0, 1.0},
                                           std::pair{1.0, 1000.0}, std::pair{0.03, 730.0},
                                           std::pair{1.0 / 3.0, 1.0}));

// Keys whose numbers are lengths, in a list or a list of lists; of those of poses the first two
// are.
const std::set<std::string> kLengths{"box",           "disc",     "vertices", "polygon",
                                     "rounding",      "grown",    "radius",   "centre",
                                     "size",          "offset",   "gap",      "stays",
                                     "stride",        "strides",  "arena",    "scale",
                                     "on_parent",     "on_child", "slides",   "start_jitter",
                                     "randomisation", "x",        "y",        "within",
                                     "start",         "pose",     "at"};
const std::map<std::string, std::size_t> kLengthsInList{
    {"start", 2}, {"pose", 2}, {"at", 2}, {"within", 1}};

/// Multiplies the first `count` numbers of a list, or all of a tree without mappings.
void scale_numbers(ConfigNode& node, double scale, std::size_t count) {
  if (node.kind == ConfigNode::Kind::kScalar) {
    char text[32];
    std::snprintf(text, sizeof text, "%.15g", scale * std::stod(node.scalar));
    node.scalar = text;
  }
  for (std::size_t k = 0; k < std::min(count, node.items.size()); ++k)
    scale_numbers(node.items[k], scale, node.items.size());
}

/// Multiplies all lengths and densities of a section of a task.
void scale_section(ConfigNode& node, double scale, double density) {
  for (ConfigNode& item : node.items) scale_section(item, scale, density);
  const ConfigEntry* type = find(node, "type");
  const bool slides = type && type->value.scalar == "prismatic";
  for (auto& [key, origin, value, comment] : node.entries) {
    const auto some = kLengthsInList.find(key);
    if (value.kind == ConfigNode::Kind::kMap)
      scale_section(value, scale, density);
    else if (kLengths.contains(key) || (slides && key == "limits"))
      scale_numbers(value, scale, some == kLengthsInList.end() ? 1000 : some->second);
    else if (key == "density")
      scale_numbers(value, density, 1);
    else
      scale_section(value, scale, density);
  }
}

/// Returns the text of a file of ours with its task scaled; nothing if the task is another file's.
std::optional<std::string> scaled(const std::filesystem::path& file, double scale, double density) {
  ConfigNode root = parse_yaml(files::read_regular(file, 100000).text, file);
  for (ConfigEntry& section : root.entries) {
    if (section.key != "task") continue;
    if (section.value.kind != ConfigNode::Kind::kMap) return std::nullopt;
    scale_section(section.value, scale, density);
    for (ConfigEntry& entry : section.value.entries)
      for (ConfigNode& body : entry.value.items)
        if (entry.key == "bodies" && !find(body, "density"))
          body.entries.push_back({"density", "", token_node(number_text(density))});
  }
  return yaml_text(root);
}

TEST(ScaledFile, OfEveryTaskOfOursGivesTheSameTask) {
  int count = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(RTG_CONFIG_FOLDER))
    for (const auto& [scale, density] : {std::pair{1.0 / 3.0, 1.0}, std::pair{1.0 / 7.0, 7.0},
                                         std::pair{0.05, 1000.0}, std::pair{50.0, 0.3}}) {
      if (entry.path().extension() != ".yaml") continue;
      const auto text = scaled(entry.path(), scale, density);
      if (!text) continue;
      const Config one = load_config(entry.path()), other = parse_config(*text, entry.path());
      EXPECT_EQ(other.task.scene.bodies, one.task.scene.bodies) << entry.path() << scale;
      EXPECT_EQ(other.task.goal, one.task.goal) << entry.path() << scale;
      EXPECT_EQ(task_hash(other.task), task_hash(one.task)) << entry.path() << scale;
      const Config again = parse_config(canonical_yaml(other), "canonical.yaml");
      EXPECT_EQ(canonical_yaml(again), canonical_yaml(other)) << entry.path() << scale;
      ++count;
    }
  EXPECT_GT(count, 40);
}

TEST(ScaleKey, StandsInThePlaceOfTheRobotsRadius) {
  const Config config = parse_config(gathering(1.0, 1.0) + "  scale: 0.4\n", "gathering.yaml");
  EXPECT_EQ(config.task.units.length, 0.5);
  EXPECT_NEAR(config.task.scene.bodies[0].shape.radius(), 1.6, 1e-9);
  EXPECT_EQ(config.task.start[1].x, -6.0);
  const Config again = parse_config(canonical_yaml(config), "canonical.yaml");
  EXPECT_EQ(canonical_yaml(again), canonical_yaml(config));
}

TEST(ScaleKey, TextsOfAllScalesReadBackToTheSameBits) {
  for (const double scale : {0.05, 0.0301, 1.0 / 3.0, 50.0, 12345.678}) {
    const Config config = parsed(scale, 1.0 / scale);
    const Config again = parse_config(canonical_yaml(config), "canonical.yaml");
    EXPECT_EQ(canonical_yaml(again), canonical_yaml(config)) << scale;
    EXPECT_EQ(again.task.start, config.task.start) << scale;
    EXPECT_EQ(again.task.scene.bodies, config.task.scene.bodies) << scale;
  }
}

}  // namespace
}  // namespace rtg::config

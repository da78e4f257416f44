#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <regex>
#include <string>
#include <string_view>
#include <vector>

#include "core/math/rng.hpp"
#include "nodes/config/config.hpp"
#include "tests/nodes/config/two_boxes.hpp"

namespace rtg::config {
namespace {

constexpr int kTexts = 3000;

constexpr std::array<std::string_view, 30> kTokens{
    "[",  "]",     "{",    "}",  ": ", ", ",    "\n",   "\n  - ", "- ",   "'",
    "\"", "#",     "&a ",  "*a", "!",  "!!int", "---",  "...",    "? ",   "| ",
    "> ", "1e999", ".nan", "-1", "0",  "\t",    "\xff", "\\",     "true", "%YAML 1.2\n"};

/// Settings of every kind of value.
constexpr std::array<std::string_view, 22> kSettings{
    "search.breadth=32",
    "search.whole_plan_share=0.125",
    "search.generator=naive",
    "reverse.preset=paper",
    "train.preset=paper",
    "run.bus=udpm://239.255.76.67:7667?ttl=0",
    "run.in_process=true",
    "physics={skin: 0.01}",
    "task.name=other",
    "task.horizon=30",
    "task.bodies.1.start=[3, 0, 0.5]",
    "task.bodies.1.friction=0.25",
    "task.bodies.2.density=2",
    "task.bodies.2.shape={vertices: [[0, 0], [1, 0], [0, 1]]}",
    "task.goal.0.disc.radius=2.5",
    "task.goal.0={kind: '*', half_plane: {normal: [0, 1], offset: -1}}",
    "task.goal.0={centroid: box, disc: {centre: [0, 2], radius: 1}}",
    "task.joints=[{parent: a, child: b, on_parent: [-3, 0], on_child: [3, 0], limits: [-1, 1]}]",
    "task.goal.0={joint: '*', angles: [0.2, 0.8]}",
    "task.joints=[{parent: a, child: b, type: prismatic, axis: [1, 2], limits: [-1, 1]}]",
    "task.joints=[{parent: b, child: a, type: fixed}]",
    "task.goal.0={joint: '*', slides: [0.2, 0.8]}"};

std::size_t place(const std::string& text, Rng& rng) {
  return static_cast<std::size_t>(rng.below(static_cast<int>(text.size()) + 1));
}

/// Makes one random edit: changes a byte, puts a token in, or leaves a stretch shorter than
/// `longest` out or puts it in once more somewhere else.
void mutate(std::string& text, int longest, Rng& rng) {
  const std::size_t at = place(text, rng);
  const auto length = static_cast<std::size_t>(rng.below(longest));
  switch (rng.below(4)) {
    case 0:
      if (at < text.size()) text[at] = static_cast<char>(rng.below(256));
      break;
    case 1:
      text.insert(at, kTokens[static_cast<std::size_t>(rng.below(kTokens.size()))]);
      break;
    case 2:
      text.erase(at, length);
      break;
    default:
      text.insert(place(text, rng), text.substr(at, length));
  }
}

/// The values that a struct's visit() lists.
struct Values {
  std::vector<double> numbers;
  std::vector<std::string> texts;

  void number(const char*, double x, double, double, const char*) { numbers.push_back(x); }
  void length(const char*, double x, double, double, const char*) { numbers.push_back(x); }
  void integer(const char*, int x, int, int, const char*) { numbers.push_back(x); }
  void flag(const char*, bool x, const char*) { numbers.push_back(x); }
  void text(const char*, const std::string& x, const char*) { texts.push_back(x); }
  template <class Enum, class Names>
  void choice(const char*, Enum x, const Names&, const char*) {
    numbers.push_back(static_cast<double>(x));
  }

  bool operator==(const Values&) const = default;
};

Values values(Config config) {
  Values all;
  config.task.visit(all);
  config.task.push.visit(all);
  config.physics.visit(all);
  config.reverse.visit(all);
  config.search.visit(all);
  config.train.visit(all);
  config.run.visit(all);
  return all;
}

/// Expects a legal configuration to print as a text that reads back to equal values.
void expect_to_read_back(const Config& config, const std::string& from) {
  const std::string canonical = canonical_yaml(config);
  const Config again = parse_config(canonical, "canonical.yaml");
  EXPECT_EQ(canonical_yaml(again), canonical) << from;
  EXPECT_TRUE(values(again) == values(config)) << from;
  EXPECT_EQ(again.task.name, config.task.name) << from;
  EXPECT_EQ(again.task.scene.bodies, config.task.scene.bodies) << from;
  EXPECT_EQ(again.task.start, config.task.start) << from;
  EXPECT_EQ(again.task.scene.joints, config.task.scene.joints) << from;
  EXPECT_EQ(again.task.goal, config.task.goal) << from;
}

/// Expects a message of one line: the place, a colon, what is wrong, what is legal.
void expect_to_tell(const std::string& message, const std::string& place, const std::string& from) {
  EXPECT_TRUE(message.starts_with(place + ": ")) << message << '\n' << from;
  const std::size_t legal = message.find("; legal: ", place.size());
  ASSERT_NE(legal, std::string::npos) << message << '\n' << from;
  EXPECT_GT(legal, place.size() + 2) << message << '\n' << from;
  EXPECT_GT(message.size(), legal + 9) << message << '\n' << from;
  EXPECT_TRUE(std::ranges::none_of(message, [](unsigned char c) { return c < ' ' || c == 127; }))
      << message << '\n'
      << from;
}

/// Place that a message begins with: "FILE:LINE" of a line that the text has; empty if it is none.
std::string line_of(const std::string& message, const std::string& file, const std::string& text) {
  std::smatch found;
  if (!std::regex_search(message, found, std::regex("^" + file + ":([0-9]{1,6}): "))) return {};
  const int line = std::stoi(found[1]);
  if (line < 1 || line > std::ranges::count(text, '\n') + 1) return {};
  return file + ':' + found[1].str();
}

bool is_legal(const std::string& text) {
  try {
    expect_to_read_back(parse_config(text, "fuzz.yaml"), text);
    return true;
  } catch (const ConfigError& error) {
    const std::string place = line_of(error.what(), "fuzz.yaml", text);
    EXPECT_FALSE(place.empty()) << error.what() << '\n' << text;
    expect_to_tell(error.what(), place, text);
    return false;
  }
}

TEST(ConfigFuzz, MutatedTextsAreReadOrRefusedInOneLine) {
  const std::string whole = canonical_yaml(parse_config(testing::kTwoBoxes, "two_boxes.yaml"));
  Rng rng(20);
  int legal = 0;
  for (int k = 0; k < kTexts; ++k) {
    std::string text = k % 4 == 0 ? whole : testing::kTwoBoxes;
    for (int edits = 1 + rng.below(4); edits > 0; --edits) mutate(text, 40, rng);
    legal += is_legal(text) ? 1 : 0;
  }
  // Neither nearly all nor nearly none, or the edits would test nothing.
  EXPECT_GT(legal, kTexts / 20);
  EXPECT_LT(legal, kTexts * 19 / 20);
}

/// The flag as messages show it.
std::string shown(const std::string& setting) {
  std::string flag = "--set " + setting;
  std::ranges::replace_if(
      flag, [](unsigned char c) { return c < ' ' || c == 127; }, ' ');
  return flag;
}

bool is_legal_setting(const std::string& setting) {
  try {
    const Config config = parse_config(testing::kTwoBoxes, "two_boxes.yaml", std::array{setting});
    expect_to_read_back(config, setting);
    return true;
  } catch (const ConfigError& error) {
    expect_to_tell(error.what(), shown(setting), setting);
    return false;
  }
}

TEST(ConfigFuzz, MutatedSettingsAreReadOrRefusedInOneLine) {
  Rng rng(21);
  int legal = 0;
  for (int k = 0; k < kTexts; ++k) {
    std::string setting{kSettings[static_cast<std::size_t>(k) % kSettings.size()]};
    for (int edits = 1 + rng.below(2); edits > 0; --edits) mutate(setting, 4, rng);
    legal += is_legal_setting(setting) ? 1 : 0;
  }
  EXPECT_GT(legal, kTexts / 20);
  EXPECT_LT(legal, kTexts * 19 / 20);
}

}  // namespace
}  // namespace rtg::config

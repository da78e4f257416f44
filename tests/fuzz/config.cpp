// The text of a configuration, and flags `--set` behind it, each after a separator (U+001E).
#include "nodes/config/config.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>

#include "nodes/files/regular_file.hpp"
#include "tests/fuzz/target.hpp"
#include "tests/nodes/config/two_boxes.hpp"

namespace rtg::fuzz {
namespace {

using config::Config;

constexpr std::size_t kMostSettings = 4;
constexpr char kSeparator = '\x1e';
const std::string kFile = "fuzz.yaml";

/// Settings of every kind of value, for the text of testing::kTwoBoxes.
const std::vector<std::vector<std::string>> kSettings{
    {"search.breadth=32"},
    {"search.whole_plan_share=0.125"},
    {"search.generator=naive"},
    {"reverse.preset=paper", "train.preset=paper"},
    {"run.bus=udpm://239.255.76.67:7667?ttl=0"},
    {"run.in_process=true"},
    {"physics={skin: 0.01}"},
    {"task.name=other", "task.horizon=30"},
    {"task.bodies.1.start=[3, 0, 0.5]"},
    {"task.bodies.1.friction=0.25", "task.bodies.2.density=2"},
    {"task.bodies.2.shape={vertices: [[0, 0], [1, 0], [0, 1]]}"},
    {"task.goal.0.disc.radius=2.5"},
    {"task.goal.0={kind: '*', half_plane: {normal: [0, 1], offset: -1}}"},
    {"task.goal.0={centroid: box, disc: {centre: [0, 2], radius: 1}}"},
    {"task.joints=[{parent: a, child: b, on_parent: [-3, 0], on_child: [3, 0], limits: [-1, 1]}]",
     "task.goal.0={joint: '*', angles: [0.2, 0.8]}"},
    {"task.joints=[{parent: a, child: b, type: prismatic, axis: [1, 2], limits: [-1, 1]}]",
     "task.goal.0={joint: '*', slides: [0.2, 0.8]}"},
    {"task.joints=[{parent: b, child: a, type: fixed}]"}};

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

/// Requires a legal configuration to print as a text that reads back to equal values.
void require_to_read_back(const Config& config) {
  const std::string canonical = config::canonical_yaml(config);
  const Config again = config::parse_config(canonical, "canonical.yaml");
  require(config::canonical_yaml(again) == canonical, "the canonical text is read back");
  require(values(again) == values(config), "all values are read back");
  require(again.task.name == config.task.name, "the name is read back");
  require(again.task.scene.bodies == config.task.scene.bodies, "bodies are read back");
  require(again.task.scene.joints == config.task.scene.joints, "joints are read back");
  require(again.task.start == config.task.start, "the start is read back");
  require(again.task.goal == config.task.goal, "the goal is read back");
  require(config::config_json(again) == config::config_json(config), "the JSON is the same");
}

/// Returns whether `message` begins with the file and the number of a line that `text` has.
bool names_a_line(std::string_view message, std::string_view text) {
  if (!message.starts_with(kFile + ":")) return false;
  message.remove_prefix(kFile.size() + 1);
  int line = 0;
  const auto [end, error] = std::from_chars(message.data(), message.data() + message.size(), line);
  return error == std::errc{} && line >= 1 && line <= std::ranges::count(text, '\n') + 1 &&
         message.substr(static_cast<std::size_t>(end - message.data())).starts_with(": ");
}

/// Requires a message of one line: the place or the flag, what is wrong, what is legal.
void require_to_tell(const std::string& message, std::string_view text, bool has_flags) {
  require(names_a_line(message, text) || (has_flags && message.starts_with("--set ")),
          "the place is told: " + message);
  const std::size_t legal = message.find("; legal: ");
  require(legal != std::string::npos && message.size() > legal + 9, "a remedy is told: " + message);
  require(std::ranges::none_of(message, [](unsigned char c) { return c < ' ' || c == 127; }),
          "the message is one line: " + message);
}

void check(const std::string& text, std::span<const std::string> settings) {
  std::optional<Config> config;
  try {
    config = config::parse_config(text, kFile, settings);
  } catch (const config::ConfigError& error) {
    require_to_tell(error.what(), text, !settings.empty());
  }
  if (config) require_to_read_back(*config);
}

/// Returns whether the goal of the task is a tight fit. Once a change has made it impossible, the
/// loader tries for seconds, under sanitizers, before it says so.
bool is_tight(const std::filesystem::path& file) {
  return std::ranges::count(std::array{"insert", "key", "plug"}, file.stem()) > 0;
}

/// Returns whether the task of a text is in it, not in another file, which is not found from here.
bool has_own_task(const std::string& text) { return text.find("\n  bodies:") != std::string::npos; }

std::string with(std::string text, std::span<const std::string> settings) {
  for (const std::string& setting : settings) text += kSeparator + setting;
  return text;
}

}  // namespace

std::vector<Bytes> seeds() {
  std::vector<Bytes> all;
  const std::string& small = testing::kTwoBoxes;
  all.push_back(bytes_of(small));
  all.push_back(bytes_of(config::canonical_yaml(config::parse_config(small, kFile))));
  for (const auto& settings : kSettings) all.push_back(bytes_of(with(small, settings)));
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(RTG_CONFIG_FOLDER))
    if (entry.path().extension() == ".yaml") files.push_back(entry.path());
  std::ranges::sort(files);
  for (const auto& file : files) {
    const std::string text = files::read_regular(file, 1 << 18).text;
    if (has_own_task(text) && !is_tight(file)) all.push_back(bytes_of(text));
  }
  return all;
}

}  // namespace rtg::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace rtg::fuzz;
  const std::string all(reinterpret_cast<const char*>(data), size);
  std::vector<std::string> parts;
  for (std::size_t at = 0; at <= size && parts.size() <= kMostSettings;) {
    const std::size_t end = std::min(all.find(kSeparator, at), size);
    parts.push_back(all.substr(at, end - at));
    at = end + 1;
  }
  check(parts[0], std::span(parts).subspan(1));
  return 0;
}

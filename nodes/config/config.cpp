#include "nodes/config/config.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <optional>
#include <regex>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <vector>

#include "nodes/bus/bus_url.hpp"
#include "nodes/bus/content_hash.hpp"
#include "nodes/config/config_overrides.hpp"
#include "nodes/config/core_digest.hpp"
#include "nodes/config/field_writer.hpp"
#include "nodes/config/method.hpp"
#include "nodes/config/run_checks.hpp"
#include "nodes/config/start_checks.hpp"
#include "nodes/config/suggestion.hpp"
#include "nodes/config/task_section.hpp"
#include "nodes/config/train_preset.hpp"
#include "nodes/config/yaml_parser.hpp"
#include "nodes/files/regular_file.hpp"

namespace rtg::config {
namespace {

using Kind = ConfigNode::Kind;

const std::vector<std::string> kSections{"task",   "physics", "forward", "reverse",
                                         "search", "train",   "run"};
const std::string kTaskLegal = "a mapping, or the path of a YAML file with a section 'task'";

std::string read_text(const std::filesystem::path& file, const std::string& origin) {
  files::Content content = files::read_regular(file, kMaxYamlBytes);
  if (!content.defect.empty())
    throw ConfigError(origin + ": " + content.defect +
                      "; legal: a YAML file with a section 'task'");
  return std::move(content.text);
}

ConfigNode parse_root(const std::string& text, const std::string& name) {
  ConfigNode root = parse_yaml(text, name);
  if (root.kind != Kind::kMap)
    throw ConfigError((root.origin.empty() ? name + ":1" : root.origin) + ": holds " +
                      in_words(root) + "; legal: a mapping with keys among " + listed(kSections));
  root.origin = name + ":1";
  return root;
}

/// If the section `task` is a path, replaces it by the section `task` of the file at that path.
void fetch_task(ConfigNode& root, const std::filesystem::path& folder) {
  for (ConfigEntry& entry : root.entries) {
    if (entry.key != "task" || entry.value.kind != Kind::kScalar) continue;
    const std::filesystem::path file = folder / entry.value.scalar;
    const std::string where = entry.value.origin + ": key 'task': " + file.string();
    const ConfigNode other = parse_root(read_text(file, where), file.string());
    const ConfigEntry* task = find(other, "task");
    if (!task || task->value.kind != Kind::kMap)
      throw ConfigError(where + ": has no mapping 'task'; legal: " + kTaskLegal);
    entry.value = task->value;
  }
}

/// Removes the file's values of the keys in which the presets of `section` differ. A preset on the
/// command line takes precedence over these values.
template <class Section, class Preset>
void clear_for_preset(ConfigNode& root, const std::string& section, Section (*values)(Preset)) {
  const ConfigNode a = fields_of(values(Preset::kDefault)), b = fields_of(values(Preset::kPaper));
  for (ConfigEntry& entry : root.entries) {
    if (entry.key != section) continue;
    std::erase_if(entry.value.entries, [&](const ConfigEntry& field) {
      const ConfigEntry* value = find(a, field.key);
      return value && value->value.scalar != find(b, field.key)->value.scalar;
    });
  }
}

/// Returns the method of that name; nothing if there is none, which is told elsewhere.
std::optional<Method> method_named(std::string_view name) {
  const auto found = std::ranges::find(kMethods, name);
  if (found == kMethods.end()) return std::nullopt;
  return static_cast<Method>(found - kMethods.begin());
}

/// Returns the value that `method` gives to a key; nothing if it gives none.
std::optional<std::string_view> value_of(std::optional<Method> method,
                                         const MethodSetting& setting) {
  if (!method) return std::nullopt;
  for (const auto& [section, key, value, of_task] : settings_of(*method))
    if (section == setting.section && key == setting.key) return value;
  return std::nullopt;
}

/// Removes the file's values of all keys that methods set: the method `name` of the command line
/// takes precedence over them. Those of_task stay that neither this method nor the file's gives.
void clear_for_method(ConfigNode& root, std::string_view name) {
  const ConfigEntry* of_file = find(root, "run", "method");
  const auto before = of_file ? method_named(of_file->value.scalar) : RunConfig{}.method;
  const auto is_to_go = [&](const MethodSetting& setting, const ConfigNode& value) {
    return !setting.of_task || value_of(method_named(name), setting) ||
           value_of(before, setting) == value.scalar;
  };
  for (std::size_t k = 0; k < kMethods.size(); ++k)
    for (const MethodSetting& setting : settings_of(static_cast<Method>(k)))
      for (ConfigEntry& entry : root.entries)
        if (entry.key == setting.section)
          std::erase_if(entry.value.entries, [&](const ConfigEntry& field) {
            return field.key == setting.key && is_to_go(setting, field.value);
          });
}

/// Removes the file's strides, which the command line gives, by whichever of the two keys.
void clear_for_strides(ConfigNode& root) {
  for (ConfigEntry& task : root.entries)
    for (ConfigEntry& push : task.value.entries)
      if (task.key == "task" && push.key == "push")
        std::erase_if(push.value.entries, [](const ConfigEntry& field) {
          return field.key == "stride" || field.key == "strides";
        });
}

void apply_overrides(ConfigNode& root, std::span<const std::string> overrides) {
  for (const std::string& setting : overrides) {
    if (setting.starts_with("reverse.preset="))
      clear_for_preset(root, "reverse", reverse::reverse_preset);
    if (setting.starts_with("train.preset=")) clear_for_preset(root, "train", train_preset);
    if (setting.starts_with("run.method="))
      clear_for_method(root, std::string_view(setting).substr(sizeof("run.method=") - 1));
    if (setting.starts_with("task.push.stride")) clear_for_strides(root);
  }
  for (const std::string& setting : overrides) apply_override(root, setting);
}

/// Returns the section `name` of `root`. Creates an empty one with `origin` if it is missing.
ConfigNode& section_of(ConfigNode& root, std::string_view name, const std::string& origin) {
  for (ConfigEntry& entry : root.entries)
    if (entry.key == name) return entry.value;
  root.entries.push_back({std::string(name), origin, map_node(origin)});
  return root.entries.back().value;
}

template <class Section>
void read_section(const ConfigNode& root, const std::string& name, Section& config,
                  const tasks::Units& units = {}) {
  if (const ConfigEntry* section = find(root, name))
    read_fields(section->value, name, config, units);
}

/// Adds the settings of the run's method for all keys that are not given.
void apply_method(ConfigNode& root) {
  RunConfig run;
  read_section(root, "run", run);
  for (const auto& [name, key, value, of_task] : settings_of(run.method)) {
    const std::string origin =
        "run.method " + std::string(kMethods[static_cast<std::size_t>(run.method)]);
    ConfigNode& section = section_of(root, name, origin);
    if (section.kind != Kind::kMap || find(section, key)) continue;
    section.entries.push_back(
        {std::string(key), origin, parse_yaml_value(std::string(value), origin)});
  }
}

/// Reads section `name`. Its field `preset` determines the values of the fields that are not given.
template <class Section, class Preset>
void read_preset_section(const ConfigNode& root, const std::string& name, Section (*values)(Preset),
                         Section& config, const tasks::Units& units = {}) {
  read_section(root, name, config, units);
  config = values(config.preset);
  read_section(root, name, config, units);
}

void check_physics(const ConfigNode& root, const PhysicsConfig& physics) {
  if (physics.skin < physics.range) return;
  const ConfigEntry* given = find(root, "physics", "skin");
  if (!given) given = find(root, "physics", "range");
  throw ConfigError(given->value.origin, "physics.skin",
                    number_text(physics.skin) + " is not below physics.range",
                    "less than " + number_text(physics.range));
}

/// Throws ConfigError if physics.inertia (dynamic mode) is true and there is too little damping.
void check_inertia(const ConfigNode& root, const Config& config) {
  if (!config.physics.inertia) return;
  const ConfigEntry *flag = find(root, "physics", "inertia"),
                    *damping = find(root, "physics", "damping");
  if (config.physics.damping < kLeastInertialDamping)
    throw ConfigError(
        (damping ? damping : flag)->value.origin, "physics.damping",
        number_text(config.physics.damping) + " is too small with physics.inertia: true",
        number_text(kLeastInertialDamping) + " or more");
}

/// Throws ConfigError if a field `randomise` is true but task.randomisation is 0.
void check_randomisation(const ConfigNode& root, const Config& config) {
  if (config.task.randomisation > 0.0) return;
  for (const auto& [section, asked] :
       {std::pair{"train", config.train.randomise}, std::pair{"search", config.search.randomise}})
    if (asked)
      throw ConfigError(find(root, section, "randomise")->value.origin, "task.randomisation",
                        std::string("is 0, but ") + section + ".randomise is true", "more than 0");
}

void check_bus(const ConfigNode& root, const std::string& url) {
  try {
    (void)bus::parse_bus_url(url);
  } catch (const std::invalid_argument& error) {
    throw ConfigError(find(root, "run", "bus")->value.origin + ": key 'run.bus': " + error.what());
  }
}

/// Throws ConfigError unless `engine` is the name of an engine or of a class in Python.
void check_engine(const ConfigNode& root, const std::string& engine) {
  static const std::vector<std::string> names{std::string(forward::kBox2d),
                                              std::string(forward::kNewton), "mujoco"};
  static const std::regex python(R"(\w+(\.\w+)*:[A-Za-z_]\w*)");
  if (std::ranges::count(names, engine) > 0 || std::regex_match(engine, python)) return;
  throw ConfigError(find(root, "forward", "engine")->value.origin, "forward.engine",
                    '\'' + engine + "' is no engine" + suggestion(engine, names),
                    listed(names) + ", or module:Class, a class in Python");
}

ConfigNode tree_of(const Config& config) {
  ConfigNode root = map_node();
  root.entries.push_back({"task", "", task_node(config.task)});
  root.entries.push_back({"physics", "", fields_of(config.physics)});
  root.entries.push_back({"forward", "", fields_of(config.forward)});
  root.entries.push_back({"reverse", "", fields_of(config.reverse)});
  root.entries.push_back({"search", "", fields_of(config.search)});
  root.entries.push_back({"train", "", fields_of(config.train, config.task.units)});
  root.entries.push_back({"run", "", fields_of(config.run)});
  return root;
}

/// Throws ConfigError for a key at the root that belongs in a section, for example `breadth` for
/// `search.breadth`.
void check_sections(const ConfigNode& root) {
  const ConfigNode known = tree_of({});
  for (const ConfigEntry& entry : root.entries)
    for (const ConfigEntry& section : known.entries)
      if (!find(known, entry.key) && find(section.value, entry.key))
        throw ConfigError(entry.origin, entry.key,
                          "no such section (did you mean '" + section.key + '.' + entry.key + "'?)",
                          listed(kSections));
}

/// Returns the number of transitions of tasks that do not tell it. More objects have to be moved in
/// more steps: with 60,000 the budget is gone before a tree of eight boxes reaches the start. Where
/// starts are drawn from ranges, each tree tells of one of them.
int default_transitions(const tasks::Task& task) {
  constexpr int kPerObject = 20000, kPerRange = 60000;
  int sum = 0;
  for (std::size_t i = 1; i < task.scene.size(); ++i) {
    if (!task.scene.bodies[i].fixed) sum += task.start_range(i) ? kPerRange : kPerObject;
  }
  return std::max(search::SearchConfig{}.transitions, sum);
}

Config read_config(const ConfigNode& root) {
  check_sections(root);
  const FieldReader reader(root, "", kSections);
  Config config;
  config.task = read_task(reader.required("task", kTaskLegal).value);
  read_section(root, "physics", config.physics);
  read_section(root, "forward", config.forward);
  read_preset_section(root, "reverse", reverse::reverse_preset, config.reverse);
  config.search.transitions = default_transitions(config.task);
  read_section(root, "search", config.search);
  read_preset_section(root, "train", train_preset, config.train, config.task.units);
  read_section(root, "run", config.run);
  check_physics(root, config.physics);
  check_inertia(root, config);
  check_randomisation(root, config);
  check_jitters(config, root);
  check_bus(root, config.run.bus);
  check_engine(root, config.forward.engine);
  check_run(config, root);
  if (config.run.workers == 0)
    config.run.workers = std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, 1024);
  return config;
}

/// Reads `file` with `overrides`. An override may make another value of the file illegal. The error
/// then names the override as well as the line of the file.
Config read_config(const ConfigNode& file, std::span<const std::string> overrides) {
  try {
    ConfigNode root = file;
    apply_overrides(root, overrides);
    apply_method(root);
    return read_config(root);
  } catch (const ConfigError& error) {
    const std::string message = error.what();
    if (overrides.empty() || message.starts_with("--set ")) throw;
    try {
      (void)read_config(file, overrides.first(overrides.size() - 1));
    } catch (const ConfigError& earlier) {
      if (std::string(earlier.what()).ends_with(message)) throw;
      throw error;  // without the last override there is a different error
    }
    throw ConfigError("--set " + overrides.back() + ": " + message);
  }
}

}  // namespace

Config load_config(const std::filesystem::path& file, std::span<const std::string> overrides) {
  return parse_config(read_text(file, file.string()), file, overrides);
}

Config parse_config(const std::string& text, const std::filesystem::path& name,
                    std::span<const std::string> overrides) {
  ConfigNode root = parse_root(text, name.string());
  fetch_task(root, name.parent_path());
  return read_config(root, overrides);
}

std::string canonical_yaml(const Config& config) { return yaml_text(tree_of(config)); }

std::string config_json(const Config& config) { return json_text(tree_of(config)); }

std::int64_t config_hash(const Config& config) {
  return bus::ContentHash().add(canonical_yaml(config)).value();
}

std::int64_t generation_hash(const Config& config) {
  Config deciding = config;
  deciding.train = {};
  deciding.run = {};
  deciding.run.seed = config.run.seed;
  return bus::ContentHash().add(core_digest()).add(canonical_yaml(deciding)).value();
}

std::int64_t task_hash(tasks::Task task) {
  const tasks::Task neutral;
  task.name = "task";
  task.units = {};
  task.horizon = neutral.horizon;
  task.discount = neutral.discount;
  task.start_jitter = neutral.start_jitter;
  task.randomisation = neutral.randomisation;
  task.start_ranges.clear();
  const auto stays = [&](std::size_t i) {
    return std::ranges::any_of(task.goal, [&](const tasks::GoalTerm& term) {
      return std::holds_alternative<tasks::Stays>(term.condition) && concerns(term, task.scene, i);
    });
  };
  for (std::size_t i = 0; i < task.start.size(); ++i)
    if (!task.scene.bodies[i].fixed && !stays(i)) task.start[i] = {};
  std::string zeros;  // of the joints whose values count from the start
  for (const Joint& joint : task.scene.joints)
    if (joint.type != JointType::kRevolute)
      for (const double x : {joint.on_parent.x(), joint.on_parent.y(), joint.angle})
        zeros += number_text(x) + ' ';
  task.start = with_closed_joints(task.scene, std::move(task.start));
  return bus::ContentHash().add(yaml_text(task_node(std::move(task)))).add(zeros).value();
}

}  // namespace rtg::config

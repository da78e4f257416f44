#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "core/reverse/problem/reverse_config.hpp"
#include "core/search/search_config.hpp"
#include "core/tasks/task.hpp"
#include "core/world/physics_config.hpp"
#include "nodes/config/config_error.hpp"
#include "nodes/config/run_config.hpp"
#include "nodes/config/train_config.hpp"

namespace rtg::config {

/// The complete, checked configuration of a run. Its members are the sections of the YAML file.
struct Config {
  tasks::Task task;
  PhysicsConfig physics;
  reverse::ReverseConfig reverse;
  search::SearchConfig search;
  TrainConfig train;
  RunConfig run;
};

/// Reads and checks a configuration file. Only the section `task` is required: a mapping, or the
/// path, relative to `file`, of another file that holds the section.
///
/// `overrides` have the form section.key=value. They take precedence over the file, later ones over
/// earlier ones. A preset among them also takes precedence over the file's values of those keys in
/// which presets differ, and a method over the file's values of the keys that methods set. The
/// values of a method take precedence over those of a preset. Throws ConfigError.
Config load_config(const std::filesystem::path& file, std::span<const std::string> overrides = {});

/// Reads and checks the text of a configuration file as load_config() does. `name` is the name of
/// the file: messages contain it, and paths in the text are relative to its folder.
Config parse_config(const std::string& text, const std::filesystem::path& name,
                    std::span<const std::string> overrides = {});

/// Returns all values as YAML, with the legal values in comments. Reading the text gives the same
/// configuration, and its canonical text is the same.
std::string canonical_yaml(const Config& config);

/// Returns the same values as JSON, for Python.
std::string config_json(const Config& config);

/// Returns the hash of canonical_yaml(), which identifies the configuration in messages and run
/// folders.
std::int64_t config_hash(const Config& config);

}  // namespace rtg::config

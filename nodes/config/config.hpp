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

/// Everything that a run is made from, checked. The sections of the YAML have the same names.
struct Config {
  tasks::Task task;
  PhysicsConfig physics;
  reverse::ReverseConfig reverse;
  search::SearchConfig search;
  TrainConfig train;
  RunConfig run;
};

/// Reads a configuration file. Only its section `task` must be there: a mapping, or the path of the
/// file, relative to this one, that holds it. `overrides` are `section.key=value` and stand above
/// the file in their order; a preset among them also stands above the file's values of the keys
/// that presets decide, and likewise a method, which stands above presets. Throws ConfigError.
Config load_config(const std::filesystem::path& file, std::span<const std::string> overrides = {});

/// The same from the text of a file; `name` is for messages, and what its paths are relative to.
Config parse_config(const std::string& text, const std::filesystem::path& name,
                    std::span<const std::string> overrides = {});

/// All values with what is legal as comments. Reads back to the same configuration and text.
std::string canonical_yaml(const Config& config);

/// The same values for Python.
std::string config_json(const Config& config);

/// The hash of the canonical text, which names the configuration in messages and run folders.
std::int64_t config_hash(const Config& config);

}  // namespace rtg::config

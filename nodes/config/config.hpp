#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "core/forward/forward_config.hpp"
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
  forward::ForwardConfig forward;
  reverse::ReverseConfig reverse;
  search::SearchConfig search;
  TrainConfig train;
  RunConfig run;

  /// Returns the discount of the learner, γ.
  double learner_discount() const { return train.discount > 0.0 ? train.discount : task.discount; }
  /// Return the largest random displacement of an object in x and y at the start of an episode of
  /// evaluation or training [m].
  double evaluation_jitter() const {
    return train.randomise ? task.randomisation : task.start_jitter;
  }
  double training_jitter() const {
    return train.randomise ? std::max(train.start_jitter, task.randomisation) : train.start_jitter;
  }
};

/// Reads and checks a configuration file. Throws ConfigError if it is not legal. Only the section
/// `task` is required. It is a mapping, or the path of another file with that section, relative to
/// `file`.
///
/// `overrides` have the form section.key=value. The value of a key is the first of these that
/// exists:
///
///  1. the last override of the key;
///  2. the value in the file, unless an override hides it. An override of run.method hides the keys
///     that methods set. An override of a preset hides the keys in which the presets differ;
///  3. the value that the method (run.method) sets;
///  4. the value of the section's preset, or the default.
Config load_config(const std::filesystem::path& file, std::span<const std::string> overrides = {});

/// Reads and checks the text of a configuration file as load_config() does. `name` is the path of
/// the file: it appears in messages, and paths in the text are relative to its folder.
Config parse_config(const std::string& text, const std::filesystem::path& name,
                    std::span<const std::string> overrides = {});

/// Returns all values as YAML, with the legal values in comments. parse_config() reads the text
/// back as an equal configuration with the same text.
std::string canonical_yaml(const Config& config);

/// Returns the same values as JSON, for Python.
std::string config_json(const Config& config);

/// Returns the hash of canonical_yaml(). It identifies the configuration in messages and run
/// folders.
std::int64_t config_hash(const Config& config);

/// Returns the hash of all that decides the transitions of a run: the compiled core, the seed, and
/// the sections but for `train` and `run`.
std::int64_t generation_hash(const Config& config);

/// Returns the hash of what a policy of the task is about: bodies, joints, goal and pushes. Names
/// of the task, starts of bodies that can move, and the lengths of episodes do not count.
std::int64_t task_hash(tasks::Task task);

}  // namespace rtg::config

#include "nodes/config/run_checks.hpp"

#include <initializer_list>
#include <string>
#include <string_view>

#include "nodes/config/config_error.hpp"

namespace rtg::config {
namespace {

/// The section and key of a value.
struct Field {
  std::string_view section, key;
};

/// Returns the origin of the first of `fields` that a file or a flag gives, else that of the root.
/// Skips defaults and values of a method, which are consistent with each other.
std::string place(const ConfigNode& root, std::initializer_list<Field> fields) {
  for (const auto& [section, key] : fields) {
    const ConfigEntry* value = find(root, section, key);
    if (value && !value->value.origin.starts_with("run.method ")) return value->value.origin;
  }
  return root.origin;
}

/// Returns whether the steps of `generator` are known to lead to success. Only those of trees are:
/// a forward search also stores steps into dead ends.
bool leads_to_success(search::Generator generator) {
  return generator == search::Generator::kRrbs || generator == search::Generator::kNaive;
}

void check_learner(const Config& config, const ConfigNode& root) {
  const TrainConfig& train = config.train;
  const Field learner{"train", "learner"}, interact{"train", "interact"},
      offline{"train", "offline"}, generator{"search", "generator"};
  if (train.learner == Learner::kPlanning) {
    if (train.interact || train.offline)
      throw ConfigError(place(root, {learner, interact, offline}), "train.learner",
                        "planning neither interacts nor learns from transitions",
                        "planning with train.interact false and train.offline false");
    return;
  }
  if (!train.interact && !train.offline)
    throw ConfigError(
        place(root, {interact, offline}), "train.interact",
        "train.interact and train.offline are both false, which leaves nothing to learn from",
        "one of the two true, or train.learner planning");
  if (train.learner == Learner::kCloning &&
      (train.interact || !leads_to_success(config.search.generator)))
    throw ConfigError(place(root, {learner, interact, generator}), "train.learner",
                      "cloning only imitates generated steps that lead to success",
                      "cloning with train.interact false and search.generator one of rrbs, naive");
}

void check_buffer(const Config& config, const ConfigNode& root) {
  const int transitions = config.search.transitions, buffer = config.train.buffer;
  if (!config.train.offline || buffer >= transitions) return;
  throw ConfigError(place(root, {{"train", "buffer"}, {"search", "transitions"}}), "train.buffer",
                    std::to_string(buffer) +
                        " is too small for search.transitions = " + std::to_string(transitions),
                    "at least as many as search.transitions");
}

void check_shards(const Config& config, const ConfigNode& root) {
  const int transitions = config.search.transitions, shards = config.search.shards;
  if (shards <= transitions) return;
  throw ConfigError(place(root, {{"search", "shards"}, {"search", "transitions"}}), "search.shards",
                    std::to_string(shards) +
                        " is too many for search.transitions = " + std::to_string(transitions),
                    "at most as many as search.transitions");
}

void check_record(const Config& config, const ConfigNode& root) {
  if (!config.run.record || (config.train.offline && !config.run.in_process)) return;
  const std::string why = config.run.in_process ? "with run.in_process" : "without train.offline";
  throw ConfigError(place(root, {{"run", "record"}}), "run.record",
                    "is true, but " + why + " there are no messages to record", "false");
}

}  // namespace

void check_run(const Config& config, const ConfigNode& root) {
  check_learner(config, root);
  check_buffer(config, root);
  check_shards(config, root);
  check_record(config, root);
}

}  // namespace rtg::config

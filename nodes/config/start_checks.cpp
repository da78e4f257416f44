#include "nodes/config/start_checks.hpp"

#include <string>

#include "core/tasks/task.hpp"
#include "nodes/config/config_error.hpp"
#include "nodes/config/field_reader.hpp"

namespace rtg::config {
namespace {

constexpr int kHalvings = 10;

/// Halves `amplitude` until it is legal and returns it. Returns 0 if no amplitude down to 0.1 % of
/// the original one is legal.
double legal_amplitude(const tasks::Task& task, double amplitude) {
  for (int k = 0; k < kHalvings; ++k) {
    amplitude /= 2.0;
    if (allows_jitter(task, amplitude)) return amplitude;
  }
  return 0.0;
}

/// Returns the place where the value was given. For a default, returns that of the bodies, which
/// then are the cause of the error.
const std::string& origin_of(const ConfigNode& root, const char* section, const char* key) {
  if (const ConfigEntry* value = find(root, section, key)) return value->value.origin;
  return find(root, "task", "bodies")->value.origin;
}

}  // namespace

void check_jitters(const Config& config, const ConfigNode& root) {
  const struct {
    const char *section, *key;
    double amplitude;
  } jitters[] = {{"task", "start_jitter", config.task.start_jitter},
                 {"task", "randomisation", config.task.randomisation},
                 {"train", "start_jitter", config.train.start_jitter}};
  for (const auto& [section, key, amplitude] : jitters) {
    tasks::Refusals refusals;
    if (!allows_jitter(config.task, amplitude, &refusals))
      throw ConfigError(
          origin_of(root, section, key), std::string(section) + '.' + key,
          "with objects shifted by up to " + length_text(amplitude, config.task.units) +
              " m too few starts are legal (bodies " +
              length_text(tasks::kStartClearance, config.task.units) +
              " m apart, objects in the arena, goal not met); " +
              main_reason(refusals, config.task.scene),
          "at most " + length_text(legal_amplitude(config.task, amplitude), config.task.units) +
              " m with these bodies");
  }
}

}  // namespace rtg::config

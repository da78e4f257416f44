#pragma once

#include <array>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/tasks/units.hpp"
#include "core/world/pose.hpp"
#include "nodes/config/config_error.hpp"
#include "nodes/config/config_tree.hpp"

namespace rtg::config {

/// Visitor that reads a mapping of a configuration into the fields of a struct. Fields whose key is
/// not given keep their values. All functions throw ConfigError for illegal values.
class FieldReader {
 public:
  /// `section`: the mapping. `path`: its dotted key, "" at the root. `keys`: all legal keys. Any
  /// other key throws ConfigError. Lengths are given in m; they and their bounds are returned and
  /// passed in `units`.
  FieldReader(const ConfigNode& section, std::string path, std::span<const std::string> keys,
              const tasks::Units& units = {});

  void number(const char* key, double& value, double least, double most, const char* doc = "");
  void length(const char* key, double& value, double least, double most, const char* doc = "");
  void integer(const char* key, int& value, int least, int most, const char* doc = "");
  void flag(const char* key, bool& value, const char* doc = "");
  void text(const char* key, std::string& value, const char* doc = "");

  template <class Enum, std::size_t N>
  void choice(const char* key, Enum& value, const std::array<std::string_view, N>& names,
              const char* = "") {
    if (const ConfigEntry* entry = find(section_, key))
      value = static_cast<Enum>(index_of(*entry, names));
  }

  /// Returns the entry of `key`. Throws ConfigError that states `legal`, the legal values, if it is
  /// missing.
  const ConfigEntry& required(const char* key, const std::string& legal) const;

  /// Returns the list at `key`. Throws ConfigError if it does not have `count` entries.
  const std::vector<ConfigNode>& items(const char* key, std::size_t count,
                                       const std::string& legal) const;

  /// Returns the list of numbers at `key`. Throws ConfigError that states `legal` if it does not
  /// have `count` entries in [least, most]. `unit`: that of the numbers, for messages.
  std::vector<double> numbers(const char* key, std::size_t count, double least, double most,
                              const std::string& legal, const std::string& unit = "") const;
  std::vector<double> lengths(const char* key, std::size_t count, double least, double most,
                              const std::string& legal) const;
  /// Returns the pose [x, y, theta] in m and rad at `key`.
  Pose pose(const char* key, double most, const std::string& legal) const;

  const tasks::Units& units() const { return units_; }
  const ConfigNode& section() const { return section_; }
  std::string path(const std::string& key) const { return path_.empty() ? key : path_ + '.' + key; }

 private:
  int index_of(const ConfigEntry& entry, std::span<const std::string_view> names) const;

  const ConfigNode& section_;
  std::string path_;
  tasks::Units units_;
};

/// Returns the number that the scalar `node` holds. `path`: its dotted key, `unit`: that of the
/// number, for messages. Throws ConfigError if `node` is no number in [least, most].
double read_number(const ConfigNode& node, const std::string& path, double least, double most,
                   const std::string& unit = "");
/// Reads an angle of at most a full turn [rad]; more are most likely degrees.
double read_angle(const ConfigNode& node, const std::string& path);

/// Returns the words for a legal length: "a number from 0.01 to 100.0 [m]".
std::string length_range(double least, double most, const tasks::Units& units);

/// Returns the length in `units` that the scalar `node` holds in m, in [least, most] `units`.
double read_length(const ConfigNode& node, const std::string& path, double least, double most,
                   const tasks::Units& units);

/// Returns the shortest text with a decimal point that is read back as `number`.
std::string number_text(double number);

/// Returns the shortest text of a number near `number` of which is_right() holds; all digits if
/// there is none.
std::string shortest_text(double number, const std::function<bool(double)>& is_right);

/// Returns the shortest text that read_length() reads back as the length `x` in `units`.
std::string length_text(double x, const tasks::Units& units);

/// Returns the same for a density.
std::string density_text(double x, const tasks::Units& units);

/// Returns the shortest text that is read back as the length `x`, rounded to single precision.
std::string single_length_text(double x, const tasks::Units& units);

/// Returns the shortest text with a decimal point that single precision reads back as `number`.
std::string single_text(float number);

/// Returns the words joined by commas: "a, b, c".
std::string listed(std::span<const std::string> words);

}  // namespace rtg::config

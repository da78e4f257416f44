#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "nodes/config/config_error.hpp"
#include "nodes/config/config_tree.hpp"

namespace rtg::config {

/// A mapping of a configuration on its way into a struct: reads by key what is there, leaves the
/// rest of the struct as it is. As a visitor it takes the fields that visit() lists. All functions
/// throw ConfigError for what is not legal.
class FieldReader {
 public:
  /// `section`: the mapping. `path`: its dotted key, "" at the root. `keys`: all that are legal in
  /// it.
  FieldReader(const ConfigNode& section, std::string path, std::span<const std::string> keys);

  void number(const char* key, double& value, double least, double most, const char* doc = "");
  void integer(const char* key, int& value, int least, int most, const char* doc = "");
  void flag(const char* key, bool& value, const char* doc = "");
  void text(const char* key, std::string& value, const char* doc = "");

  template <class Enum, std::size_t N>
  void choice(const char* key, Enum& value, const std::array<std::string_view, N>& names,
              const char* = "") {
    if (const ConfigEntry* entry = find(section_, key))
      value = static_cast<Enum>(index_of(*entry, names));
  }

  /// The entry of a key that must be there.
  const ConfigEntry& required(const char* key, const std::string& legal) const;

  /// The values of a list of `count` numbers.
  std::vector<double> numbers(const char* key, std::size_t count, double least, double most,
                              const std::string& legal) const;

  const ConfigNode& section() const { return section_; }
  std::string path(const std::string& key) const { return path_.empty() ? key : path_ + '.' + key; }

 private:
  int index_of(const ConfigEntry& entry, std::span<const std::string_view> names) const;

  const ConfigNode& section_;
  std::string path_;
};

/// The finite number that a scalar spells in full. Throws ConfigError.
double read_number(const ConfigNode& node, const std::string& path, double least, double most);

/// `number` as the shortest text that reads back to it, with a point or an exponent.
std::string number_text(double number);

/// The same for a number in single precision.
std::string single_text(float number);

/// "a, b, c".
std::string listed(std::span<const std::string> words);

}  // namespace rtg::config

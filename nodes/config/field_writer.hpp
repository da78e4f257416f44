#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "nodes/config/config_tree.hpp"
#include "nodes/config/field_reader.hpp"

namespace rtg::config {

/// Visitor that writes the fields of a struct into a mapping, with the legal values in comments.
class FieldWriter {
 public:
  explicit FieldWriter(const tasks::Units& units = {}) : units_(units) {}

  ConfigNode section = map_node();

  void length(const char* key, double value, double least, double most, const char* doc);
  void number(const char* key, double value, double least, double most, const char* doc);
  void integer(const char* key, int value, int least, int most, const char* doc);
  void flag(const char* key, bool value, const char* doc);
  void text(const char* key, const std::string& value, const char* doc);

  template <class Enum, std::size_t N>
  void choice(const char* key, Enum value, const std::array<std::string_view, N>& names,
              const char* doc) {
    add(key, std::string(names[static_cast<std::size_t>(value)]), true,
        std::string(doc) + "; " + joined(names));
  }

 private:
  static std::string joined(std::span<const std::string_view> names);
  void add(const char* key, std::string value, bool quoted, std::string comment);

  tasks::Units units_;
};

/// Returns the fields of `config`, as listed by config.visit(), as a mapping. `units`: those of its
/// lengths.
template <class Section>
ConfigNode fields_of(Section config, const tasks::Units& units = {}) {
  FieldWriter writer(units);
  config.visit(writer);
  return std::move(writer.section);
}

/// Reads the fields of `config`, as listed by config.visit(), from `section`. `path`: dotted key of
/// the section. Fields that are not given keep their values.
template <class Section>
void read_fields(const ConfigNode& section, const std::string& path, Section& config,
                 const tasks::Units& units = {}) {
  std::vector<std::string> keys;
  for (const ConfigEntry& field : fields_of(config).entries) keys.push_back(field.key);
  FieldReader reader(section, path, keys, units);
  config.visit(reader);
}

}  // namespace rtg::config

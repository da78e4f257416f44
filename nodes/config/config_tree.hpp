#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace rtg::config {

struct ConfigEntry;

/// A configuration as it is written: nested mappings, lists and scalars, each with the place that
/// it was read from. Mappings keep their order.
struct ConfigNode {
  enum class Kind { kNull, kScalar, kList, kMap };
  Kind kind = Kind::kNull;
  std::string scalar;
  bool quoted = false;               // a scalar that is text whatever it looks like
  std::string origin;                // "FILE:LINE" or "--set KEY=VALUE"
  std::vector<ConfigNode> items;     // kList
  std::vector<ConfigEntry> entries;  // kMap, keys differ
};

struct ConfigEntry {
  std::string key;
  std::string origin;
  ConfigNode value;
  std::string comment = {};  // printed behind or above the value
};

/// The entry of a mapping with that key, or nullptr.
inline const ConfigEntry* find(const ConfigNode& map, std::string_view key) {
  for (const ConfigEntry& entry : map.entries)
    if (entry.key == key) return &entry;
  return nullptr;
}

/// The entry of a key of a section, or nullptr.
inline const ConfigEntry* find(const ConfigNode& root, std::string_view section,
                               std::string_view key) {
  const ConfigEntry* found = find(root, section);
  return found ? find(found->value, key) : nullptr;
}

/// Nodes of no origin: text, which YAML may not read as anything else; a number or flag; a list; a
/// mapping without entries.
ConfigNode text_node(std::string text);
ConfigNode token_node(std::string token);
ConfigNode list_node(std::vector<ConfigNode> items);
ConfigNode map_node(std::string origin = {});

/// A node in words, for messages: "'3x'", "a list", "a mapping", "nothing".
std::string in_words(const ConfigNode& node);

/// Block style with comments, as long as a mapping has some; flow style below.
std::string yaml_text(const ConfigNode& root);

/// Indented, comments left out.
std::string json_text(const ConfigNode& root);

}  // namespace rtg::config

#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace rtg::config {

struct ConfigEntry;

/// A value in a configuration text, with the place where it was given: a mapping, a list or a
/// scalar. Mappings keep the order of their entries.
struct ConfigNode {
  enum class Kind { kNull, kScalar, kList, kMap };
  Kind kind = Kind::kNull;
  std::string scalar;
  bool quoted = false;               // the scalar is text, even if it looks like a number
  std::string origin;                // "FILE:LINE" or "--set KEY=VALUE"
  std::vector<ConfigNode> items;     // kList
  std::vector<ConfigEntry> entries;  // kMap, unique keys
};

struct ConfigEntry {
  std::string key;
  std::string origin;
  ConfigNode value;
  std::string comment = {};  // printed after the value, or above it if it is a block
};

/// Returns the entry of `map` with key `key`; nullptr if there is none.
inline const ConfigEntry* find(const ConfigNode& map, std::string_view key) {
  for (const ConfigEntry& entry : map.entries)
    if (entry.key == key) return &entry;
  return nullptr;
}

/// Returns the entry with key `key` of section `section`; nullptr if there is none.
inline const ConfigEntry* find(const ConfigNode& root, std::string_view section,
                               std::string_view key) {
  const ConfigEntry* found = find(root, section);
  return found ? find(found->value, key) : nullptr;
}

/// Make a node: a text (which YAML reads back as text), a number or flag, a list, an empty mapping.
/// Only map_node() sets an origin.
ConfigNode text_node(std::string text);
ConfigNode token_node(std::string token);
ConfigNode list_node(std::vector<ConfigNode> items);
ConfigNode map_node(std::string origin = {});
ConfigNode mapping(std::vector<ConfigEntry> entries);

/// Returns `node` in words for messages: "'3x'", "a list", "a mapping", "nothing".
std::string in_words(const ConfigNode& node);

/// Returns the tree as YAML text. Block style is used for mappings with comments, lists of
/// mappings, and mappings that contain one of these. The rest is in flow style.
std::string yaml_text(const ConfigNode& root);

/// Returns the tree as indented JSON text without the comments.
std::string json_text(const ConfigNode& root);

}  // namespace rtg::config

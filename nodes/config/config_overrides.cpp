#include "nodes/config/config_overrides.hpp"

#include <algorithm>
#include <charconv>
#include <utility>

#include "nodes/config/config_error.hpp"
#include "nodes/config/yaml_parser.hpp"

namespace rtg::config {
namespace {

using Kind = ConfigNode::Kind;

ConfigNode& item_at(ConfigNode& list, const std::string& key, const std::string& flag,
                    const std::string& path) {
  std::size_t index = 0;
  const auto [end, code] = std::from_chars(key.data(), key.data() + key.size(), index);
  if (code != std::errc{} || end != key.data() + key.size() || index >= list.items.size())
    throw ConfigError(flag, path, "the list has no such entry",
                      list.items.empty()
                          ? "none, the list is empty"
                          : "a number from 0 to " + std::to_string(list.items.size() - 1));
  return list.items[index];
}

/// Returns the value of `key` in `node`. Creates a missing key of a mapping. Throws ConfigError for
/// a missing entry of a list.
ConfigNode& child(ConfigNode& node, const std::string& key, const std::string& flag,
                  const std::string& path) {
  if (node.kind == Kind::kList) return item_at(node, key, flag, path);
  if (node.kind != Kind::kMap) node = map_node(flag);
  for (ConfigEntry& entry : node.entries)
    if (entry.key == key) {
      entry.origin = flag;
      return entry.value;
    }
  node.entries.push_back({key, flag, {}});
  return node.entries.back().value;
}

}  // namespace

void apply_override(ConfigNode& root, const std::string& setting) {
  const std::string flag = "--set " + setting;
  const std::size_t equals = setting.find('=');
  if (equals == std::string::npos || equals == 0)
    throw ConfigError(flag +
                      ": is not of the form KEY=VALUE; legal: for example --set search.breadth=32");
  const std::string path = setting.substr(0, equals);
  ConfigNode* node = &root;
  for (std::size_t begin = 0; begin <= path.size();) {
    const std::size_t dot = std::min(path.find('.', begin), path.size());
    node = &child(*node, path.substr(begin, dot - begin), flag, path.substr(0, dot));
    begin = dot + 1;
  }
  *node = parse_yaml_value(setting.substr(equals + 1), flag);
  if (node->origin.empty()) node->origin = flag;
}

}  // namespace rtg::config

#pragma once

#include <cstddef>
#include <string>

#include "nodes/config/config_tree.hpp"

namespace rtg::config {

/// Largest size of a YAML text [bytes].
inline constexpr std::size_t kMaxYamlBytes = 1 << 18;

/// Parses a YAML text into a tree with the origins "file:line". Accepts one document in UTF-8 of
/// mappings with scalar keys, lists and scalars. Throws ConfigError with the line for wrong syntax,
/// duplicate keys, anchors, aliases and tags.
ConfigNode parse_yaml(const std::string& text, const std::string& file);

/// Parses `text`, the value of the flag `flag`, into a tree. All its nodes have the origin `flag`.
ConfigNode parse_yaml_value(const std::string& text, const std::string& flag);

}  // namespace rtg::config

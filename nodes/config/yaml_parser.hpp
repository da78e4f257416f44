#pragma once

#include <string>

#include "nodes/config/config_tree.hpp"

namespace rtg::config {

/// Returns the tree of a YAML text; the origins are "file:line". Accepts one document in UTF-8 of
/// mappings with scalar keys, lists and scalars. Anchors, aliases and tags are not accepted. Throws
/// ConfigError with the line for wrong syntax, a duplicate key or YAML that is not accepted.
ConfigNode parse_yaml(const std::string& text, const std::string& file);

/// Parses `text`, the value of the flag `flag`, into a tree; all its nodes have the origin `flag`.
ConfigNode parse_yaml_value(const std::string& text, const std::string& flag);

}  // namespace rtg::config

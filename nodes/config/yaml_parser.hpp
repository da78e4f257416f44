#pragma once

#include <string>

#include "nodes/config/config_tree.hpp"

namespace rtg::config {

/// The tree of a YAML text; origins are "file:line". Of YAML it takes one document of mappings with
/// plain keys, lists and scalars in UTF-8: no anchors, aliases, tags. Throws ConfigError with the
/// line for wrong syntax, a duplicate key or anything else.
ConfigNode parse_yaml(const std::string& text, const std::string& file);

/// The value of a flag: all of it has the origin `flag`.
ConfigNode parse_yaml_value(const std::string& text, const std::string& flag);

}  // namespace rtg::config

#pragma once

#include <string>

#include "core/world/polygon.hpp"
#include "nodes/config/config_tree.hpp"

namespace rtg::config {

/// Converts `section`, whose dotted key is `path`, to a shape with its centroid at the origin.
/// Legal are {box: [w, h]}, {regular: {sides: n, radius: r}} and {vertices: [[x, y], ...]}. Throws
/// ConfigError for anything else.
Polygon read_shape(const ConfigNode& section, const std::string& path);

/// Converts `shape` to the shortest section from which read_shape() reads it back.
ConfigNode shape_node(const Polygon& shape);

}  // namespace rtg::config

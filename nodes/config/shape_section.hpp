#pragma once

#include <string>

#include "core/world/polygon.hpp"
#include "nodes/config/config_tree.hpp"

namespace rtg::config {

/// Returns the shape that `section` describes, with its centroid at the origin: {box: [w, h]},
/// {regular: {sides: n, radius: r}} or {vertices: [[x, y], ...]}. Throws ConfigError.
Polygon read_shape(const ConfigNode& section, const std::string& path);

/// Returns the shortest section from which read_shape() reads `shape`.
ConfigNode shape_node(const Polygon& shape);

}  // namespace rtg::config

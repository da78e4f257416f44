#pragma once

#include <string>

#include "core/world/polygon.hpp"
#include "nodes/config/config_tree.hpp"

namespace rtg::config {

/// A shape, centred: {box: [w, h]}, {regular: {sides: n, radius: r}} or {vertices: [[x, y], ...]}.
/// Throws ConfigError.
Polygon read_shape(const ConfigNode& section, const std::string& path);

/// The shortest of these that reads back to `shape`.
ConfigNode shape_node(const Polygon& shape);

}  // namespace rtg::config

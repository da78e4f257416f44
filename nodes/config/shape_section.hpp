#pragma once

#include <string>

#include "core/tasks/units.hpp"
#include "core/world/shape.hpp"
#include "nodes/config/config_tree.hpp"

namespace rtg::config {

/// Converts `section`, whose dotted key is `path`, to a shape with its centroid at the origin.
/// Lengths are given in m and returned in `units`. Throws ConfigError if it is not legal. Legal are
/// one of
///
///   {box: [w, h]}
///   {regular: {sides: n, radius: r}}
///   {vertices: [[x, y], ...]}      a simple polygon, split if it is not convex
///   {disc: r}
///   {parts: [part, ...]}           their union, in one piece; they may overlap
///
/// A part is one of the first four, with `at: [x, y]` or `at: [x, y, theta]` where it lies. A box,
/// a regular polygon or a convex one may also have
///
///   rounding: r                    rounds its corners off, within it
///   grown: r                       adds all points within r of it
Shape read_shape(const ConfigNode& section, const std::string& path, const tasks::Units& units);

/// Converts `shape` to the shortest section from which read_shape() reads it back, to the bit.
ConfigNode shape_node(const Shape& shape, const tasks::Units& units);

}  // namespace rtg::config

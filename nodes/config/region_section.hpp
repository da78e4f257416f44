#pragma once

#include "core/tasks/region.hpp"
#include "nodes/config/config_tree.hpp"
#include "nodes/config/field_reader.hpp"

namespace rtg::config {

/// Converts `entry` of the section of `reader` to a region. Legal are the keys
///
///   disc: {centre: [x, y], radius: r}
///   half_plane: {normal: [a, b], offset: c}        a x + b y <= c
///   box: {centre: [x, y], size: [w, h], theta: t}
///   polygon: [[x, y], ...]                         convex, counter-clockwise
///
/// Throws ConfigError if the value is not legal.
tasks::Region read_region(const FieldReader& reader, const ConfigEntry& entry);

/// Converts `region` to an entry, from which read_region() reads it back. A box becomes a polygon.
ConfigEntry region_entry(const tasks::Region& region, const tasks::Units& units);

}  // namespace rtg::config

#pragma once

#include "core/tasks/goal.hpp"
#include "core/tasks/units.hpp"
#include "nodes/config/config_tree.hpp"

namespace rtg::config {

/// Converts `section`, whose dotted key is `path`, to a goal term. Legal is a subject with a
/// condition, and `not: true` where the condition is to hold for none:
///
///   kind: k          disc: {centre: [x, y], radius: r}
///                    half_plane: {normal: [a, b], offset: c}
///                    box: {centre: [x, y], size: [w, h], theta: t}
///                    polygon: [[x, y], ...]
///                    angle: [least, most]
///                    pose: [x, y, theta] with within: [distance, turn]
///                    covers: {at: [x, y, theta], share: s}
///                    touching: kind, apart: kind, with gap: g
///                    stays: r
///   centroid: k      the first four
///   joint: child     angles: [least, most], slides: [least, most]
///
/// Throws ConfigError if it is not legal.
tasks::GoalTerm read_term(const ConfigNode& section, const std::string& path,
                          const tasks::Units& units);

/// Converts `term` to a section, from which read_term() reads it back.
ConfigNode term_node(const tasks::GoalTerm& term, const tasks::Units& units);

}  // namespace rtg::config

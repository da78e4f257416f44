#pragma once

#include <string>
#include <vector>

#include "core/world/pose.hpp"
#include "nodes/config/field_reader.hpp"

namespace rtg::config {

// Helpers for reading the sections of a task. Functions with a `reader` throw ConfigError.

inline constexpr double kMaxPlace = 1000.0;  // largest coordinate, length, start angle [rad]
inline constexpr double kMaxAngle = 100.0;   // largest bound of an angle range [rad]

inline const std::string kNameLegal = "a letter, then letters, digits, _ and -, 40 at most";

/// Reads a name or a kind: a letter, then letters, digits, _ and -.
std::string name_at(const FieldReader& reader, const char* key, const std::string& legal);

/// Reads a place [x, y] in m.
Vector2d point_at(const FieldReader& reader, const char* key);

/// Returns x with its coordinates rounded by Units::rounded(), which read back as they are.
inline Vector2d on_grid(const Vector2d& x) {
  return {tasks::Units::rounded(x.x()), tasks::Units::rounded(x.y())};
}

/// Reads a direction [x, y].
Vector2d direction_at(const FieldReader& reader, const char* key);

/// Reads a range of angles [least, most] in rad, or of lengths in m.
Vector2d angles_at(const FieldReader& reader, const char* key);
Vector2d lengths_at(const FieldReader& reader, const char* key);

/// Throws ConfigError about `key` of `entry`, a mapping in a list of the task. `path`: the dotted
/// key of `entry`. The error names the place of the key, or of `entry` if the key is missing.
[[noreturn]] void fail_at(const ConfigNode& entry, const std::string& path, const char* key,
                          const std::string& wrong, const std::string& legal);

/// Reads a list of places [x, y] in m. `legal`: what is legal, for messages.
std::vector<Vector2d> points_of(const ConfigNode& list, const std::string& path,
                                const std::string& legal, const tasks::Units& units);

/// Returns what point_at(), points_of(), FieldReader::length(), lengths() and pose() read back.
ConfigNode length_node(double x, const tasks::Units& units);
ConfigNode lengths_node(const std::vector<double>& lengths, const tasks::Units& units);
ConfigNode point_node(const Vector2d& x, const tasks::Units& units);
ConfigNode pose_node(const Pose& pose, const tasks::Units& units);
ConfigNode numbers_node(const std::vector<double>& numbers);

}  // namespace rtg::config

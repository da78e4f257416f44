#pragma once

#include <string>

#include "core/world/pose.hpp"
#include "nodes/config/field_reader.hpp"

namespace rtg::config {

// What the sections of a task have in common; all functions throw ConfigError.

inline constexpr double kMaxPlace = 1000.0;  // of any place or length [m], angle of a start [rad]
inline constexpr double kMaxAngle = 100.0;   // of a range of angles [rad]

inline const std::string kNameLegal = "a letter, then letters, digits, _ and -, 40 at most";

/// A name or a kind: a letter, then letters, digits, _ and -.
std::string name_at(const FieldReader& reader, const char* key, const std::string& legal);

/// A point [x, y].
Vector2d point_at(const FieldReader& reader, const char* key);

/// A range of angles [least, most] in rad.
Vector2d angles_at(const FieldReader& reader, const char* key);

/// Says what is wrong with `key` of an entry of a list of the task, at the key's place if it is
/// given, else at the entry's.
[[noreturn]] void fail_at(const ConfigNode& entry, const std::string& path, const char* key,
                          const std::string& wrong, const std::string& legal);

ConfigNode point_node(const Vector2d& x);

}  // namespace rtg::config

#include "nodes/config/task_words.hpp"

#include <algorithm>
#include <utility>

#include "nodes/config/config_error.hpp"

namespace rtg::config {
namespace {

constexpr std::size_t kMaxName = 40;  // characters
constexpr double kLeastWidth = 0.15;  // of a range, > 2 kGoalSpare [rad], [m]
constexpr double kRounding = 1e-9;    // rounding error of that width

std::string range_legal(const std::string& width, const std::string& unit) {
  return "[least, most] in " + unit + ", with most at least " + width + " above least";
}

/// Throws ConfigError if `range` is narrower than kLeastWidth. Messages call that `width` `unit`.
Vector2d wide_enough(const std::vector<double>& range, const FieldReader& reader, const char* key,
                     const std::string& width, const std::string& unit) {
  if (range[1] - range[0] >= kLeastWidth - kRounding) return {range[0], range[1]};
  const std::string legal = range_legal(width, unit);
  const ConfigNode& node = reader.required(key, legal).value;
  const std::string &least = node.items[0].scalar, &most = node.items[1].scalar;
  throw ConfigError(node.origin, reader.path(key),
                    range[0] > range[1] ? least + " is above " + most
                                        : "the range [" + least + ", " + most +
                                              "] is narrower than " + width + ' ' + unit,
                    legal);
}

}  // namespace

std::string name_at(const FieldReader& reader, const char* key, const std::string& legal) {
  const ConfigNode& node = reader.required(key, legal).value;
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const auto is_legal = [&](char c) {
    return is_letter(c) || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  const std::string& name = node.scalar;
  if (node.kind != ConfigNode::Kind::kScalar || name.empty() || name.size() > kMaxName ||
      !is_letter(name[0]) || !std::all_of(name.begin(), name.end(), is_legal))
    throw ConfigError(node.origin, reader.path(key), in_words(node) + " is not a name", legal);
  return name;
}

Vector2d point_at(const FieldReader& reader, const char* key) {
  const auto x = reader.lengths(key, 2, -kMaxPlace, kMaxPlace, "[x, y] in m");
  return {x[0], x[1]};
}

Vector2d direction_at(const FieldReader& reader, const char* key) {
  const auto x = reader.numbers(key, 2, -kMaxPlace, kMaxPlace, "[x, y]");
  return {x[0], x[1]};
}

Vector2d angles_at(const FieldReader& reader, const char* key) {
  const std::string width = number_text(kLeastWidth);
  return wide_enough(
      reader.numbers(key, 2, -kMaxAngle, kMaxAngle, range_legal(width, "rad"), "rad"), reader, key,
      width, "rad");
}

Vector2d lengths_at(const FieldReader& reader, const char* key) {
  const std::string width = length_text(kLeastWidth, reader.units());
  return wide_enough(reader.lengths(key, 2, -kMaxPlace, kMaxPlace, range_legal(width, "m")), reader,
                     key, width, "m");
}

void fail_at(const ConfigNode& entry, const std::string& path, const char* key,
             const std::string& wrong, const std::string& legal) {
  const ConfigEntry* field = find(entry, key);
  throw ConfigError(field ? field->value.origin : entry.origin, path + '.' + key, wrong, legal);
}

std::vector<Vector2d> points_of(const ConfigNode& list, const std::string& path,
                                const std::string& legal, const tasks::Units& units) {
  if (list.kind != ConfigNode::Kind::kList)
    throw ConfigError(list.origin, path, in_words(list) + " is not a list", legal);
  std::vector<Vector2d> points;
  for (const ConfigNode& item : list.items) {
    if (item.kind != ConfigNode::Kind::kList || item.items.size() != 2)
      throw ConfigError(item.origin, path, in_words(item) + " is not a vertex [x, y]", legal);
    points.emplace_back(read_length(item.items[0], path, -kMaxPlace, kMaxPlace, units),
                        read_length(item.items[1], path, -kMaxPlace, kMaxPlace, units));
  }
  return points;
}

ConfigNode length_node(double x, const tasks::Units& units) {
  return token_node(length_text(x, units));
}

ConfigNode lengths_node(const std::vector<double>& lengths, const tasks::Units& units) {
  std::vector<ConfigNode> items;
  for (const double length : lengths) items.push_back(length_node(length, units));
  return list_node(std::move(items));
}

ConfigNode point_node(const Vector2d& x, const tasks::Units& units) {
  return lengths_node({x.x(), x.y()}, units);
}

ConfigNode pose_node(const Pose& pose, const tasks::Units& units) {
  return list_node({length_node(pose.x, units), length_node(pose.y, units),
                    token_node(number_text(pose.theta))});
}

ConfigNode numbers_node(const std::vector<double>& numbers) {
  std::vector<ConfigNode> items;
  for (const double number : numbers) items.push_back(token_node(number_text(number)));
  return list_node(std::move(items));
}

}  // namespace rtg::config

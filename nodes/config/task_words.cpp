#include "nodes/config/task_words.hpp"

#include <algorithm>
#include <utility>

#include "nodes/config/config_error.hpp"

namespace rtg::config {
namespace {

constexpr std::size_t kMaxName = 40;  // characters
constexpr double kLeastWidth = 0.15;  // of a range, > 2 kGoalSpare [rad], [m]
constexpr double kRounding = 1e-9;    // rounding error of that width

Vector2d range_at(const FieldReader& reader, const char* key, double most, const char* unit) {
  const std::string width = number_text(kLeastWidth);
  const std::string legal =
      "[least, most] in " + (unit + (", with most at least " + width)) + " above least";
  const auto range = reader.numbers(key, 2, -most, most, legal);
  if (range[1] - range[0] < kLeastWidth - kRounding)
    throw ConfigError(reader.required(key, legal).value.origin, reader.path(key),
                      "the range [" + number_text(range[0]) + ", " + number_text(range[1]) +
                          "] is narrower than " + width + ' ' + unit,
                      legal);
  return {range[0], range[1]};
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
  const auto x = reader.numbers(key, 2, -kMaxPlace, kMaxPlace, "[x, y]");
  return {x[0], x[1]};
}

Vector2d angles_at(const FieldReader& reader, const char* key) {
  return range_at(reader, key, kMaxAngle, "rad");
}

Vector2d lengths_at(const FieldReader& reader, const char* key) {
  return range_at(reader, key, kMaxPlace, "m");
}

void fail_at(const ConfigNode& entry, const std::string& path, const char* key,
             const std::string& wrong, const std::string& legal) {
  const ConfigEntry* field = find(entry, key);
  throw ConfigError(field ? field->value.origin : entry.origin, path + '.' + key, wrong, legal);
}

std::vector<Vector2d> points_of(const ConfigNode& list, const std::string& path,
                                const std::string& legal) {
  if (list.kind != ConfigNode::Kind::kList)
    throw ConfigError(list.origin, path, in_words(list) + " is not a list", legal);
  std::vector<Vector2d> points;
  for (const ConfigNode& item : list.items) {
    if (item.kind != ConfigNode::Kind::kList || item.items.size() != 2)
      throw ConfigError(item.origin, path, in_words(item) + " is not a vertex [x, y]", legal);
    points.emplace_back(read_number(item.items[0], path, -kMaxPlace, kMaxPlace),
                        read_number(item.items[1], path, -kMaxPlace, kMaxPlace));
  }
  return points;
}

ConfigNode point_node(const Vector2d& x) { return numbers_node({x.x(), x.y()}); }

ConfigNode numbers_node(const std::vector<double>& numbers) {
  std::vector<ConfigNode> items;
  for (const double number : numbers) items.push_back(token_node(number_text(number)));
  return list_node(std::move(items));
}

}  // namespace rtg::config

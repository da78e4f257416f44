#include "nodes/config/field_reader.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "nodes/config/suggestion.hpp"

namespace rtg::config {
namespace {

using Kind = ConfigNode::Kind;

constexpr std::size_t kMaxText = 200;  // characters of a text

std::string range_text(const char* what, const std::string& least, const std::string& most,
                       const std::string& unit = "") {
  return std::string(what) + " from " + least + " to " + most +
         (unit.empty() ? "" : " [" + unit + ']');
}

/// Returns the number that an unquoted scalar holds. Returns nothing if the scalar is not a number.
/// Sets `error` if the number is out of range.
template <class Number>
std::optional<Number> spelled(const ConfigNode& node, std::errc& error) {
  if (node.kind != Kind::kScalar || node.quoted) return std::nullopt;
  const char* begin = node.scalar.data();
  const char* end = begin + node.scalar.size();
  if (end - begin > 1 && *begin == '+' && begin[1] != '-') ++begin;
  Number value{};
  const auto [stop, code] = std::from_chars(begin, end, value);
  error = code;
  if (stop != end || begin == end) return std::nullopt;
  return value;
}

/// Returns the number that a scalar holds; infinite if it is out of range of numbers.
double read_number(const ConfigNode& node, const std::string& path, const std::string& legal) {
  std::errc error{};
  const std::optional<double> read = spelled<double>(node, error);
  if (!read || std::isnan(*read))
    throw ConfigError(node.origin, path, in_words(node) + " is not a number", legal);
  if (error == std::errc::result_out_of_range)
    throw ConfigError(node.origin, path, node.scalar + " is out of range", legal);
  return *read;
}

template <class Number>
std::string shortest(Number number) {
  char buffer[32];
  const auto [end, code] = std::to_chars(buffer, buffer + sizeof buffer, number);
  std::string text(buffer, end);
  if (text.find('.') != std::string::npos) return text;
  return text.insert(std::min(text.find('e'), text.size()), ".0");
}

}  // namespace

FieldReader::FieldReader(const ConfigNode& section, std::string path,
                         std::span<const std::string> keys, const tasks::Units& units)
    : section_(section), path_(std::move(path)), units_(units) {
  if (section.kind != Kind::kMap)
    throw ConfigError(section.origin, path_, in_words(section) + " is not a mapping",
                      "a mapping with keys among " + listed(keys));
  for (const ConfigEntry& entry : section.entries)
    if (std::find(keys.begin(), keys.end(), entry.key) == keys.end())
      throw ConfigError(entry.origin, this->path(entry.key),
                        "no such key" + suggestion(entry.key, keys), listed(keys));
}

void FieldReader::number(const char* key, double& value, double least, double most, const char*) {
  if (const ConfigEntry* entry = find(section_, key))
    value = read_number(entry->value, path(key), least, most);
}

void FieldReader::length(const char* key, double& value, double least, double most, const char*) {
  if (const ConfigEntry* entry = find(section_, key))
    value = read_length(entry->value, path(key), least, most, units_);
}

void FieldReader::integer(const char* key, int& value, int least, int most, const char*) {
  const ConfigEntry* entry = find(section_, key);
  if (!entry) return;
  const std::string legal = range_text("an integer", std::to_string(least), std::to_string(most));
  std::errc error{};
  const std::optional<int> read = spelled<int>(entry->value, error);
  if (!read)
    throw ConfigError(entry->value.origin, path(key), in_words(entry->value) + " is not an integer",
                      legal);
  if (error == std::errc::result_out_of_range || *read < least || *read > most)
    throw ConfigError(entry->value.origin, path(key), entry->value.scalar + " is out of range",
                      legal);
  value = *read;
}

void FieldReader::flag(const char* key, bool& value, const char*) {
  const ConfigEntry* entry = find(section_, key);
  if (!entry) return;
  const ConfigNode& node = entry->value;
  if (node.kind != Kind::kScalar || node.quoted ||
      (node.scalar != "true" && node.scalar != "false"))
    throw ConfigError(node.origin, path(key), in_words(node) + " is neither true nor false",
                      "true, false");
  value = node.scalar == "true";
}

void FieldReader::text(const char* key, std::string& value, const char*) {
  const ConfigEntry* entry = find(section_, key);
  if (!entry) return;
  const ConfigNode& node = entry->value;
  const auto is_legal = [](char c) { return c >= ' ' && c <= '~' && c != '"' && c != '\\'; };
  if (node.kind != Kind::kScalar || node.scalar.empty() || node.scalar.size() > kMaxText ||
      !std::all_of(node.scalar.begin(), node.scalar.end(), is_legal))
    throw ConfigError(
        node.origin, path(key), in_words(node) + " is not a legal text",
        "1 to " + std::to_string(kMaxText) + " ASCII characters other than \" and \\");
  value = node.scalar;
}

int FieldReader::index_of(const ConfigEntry& entry, std::span<const std::string_view> names) const {
  const ConfigNode& node = entry.value;
  if (node.kind == Kind::kScalar)
    for (std::size_t k = 0; k < names.size(); ++k)
      if (names[k] == node.scalar) return static_cast<int>(k);
  const std::vector<std::string> legal(names.begin(), names.end());
  throw ConfigError(
      node.origin, path(entry.key),
      in_words(node) + " is not one of the legal values" + suggestion(node.scalar, legal),
      listed(legal));
}

const ConfigEntry& FieldReader::required(const char* key, const std::string& legal) const {
  if (const ConfigEntry* entry = find(section_, key)) return *entry;
  throw ConfigError(section_.origin, path(key), "is missing", legal);
}

const std::vector<ConfigNode>& FieldReader::items(const char* key, std::size_t count,
                                                  const std::string& legal) const {
  const ConfigNode& node = required(key, legal).value;
  if (node.kind != Kind::kList || node.items.size() != count)
    throw ConfigError(node.origin, path(key),
                      node.kind == Kind::kList
                          ? "has " + std::to_string(node.items.size()) + " entries"
                          : in_words(node) + " is not a list",
                      legal);
  return node.items;
}

std::vector<double> FieldReader::numbers(const char* key, std::size_t count, double least,
                                         double most, const std::string& legal,
                                         const std::string& unit) const {
  std::vector<double> out;
  for (const ConfigNode& item : items(key, count, legal))
    out.push_back(read_number(item, path(key), least, most, unit));
  return out;
}

std::vector<double> FieldReader::lengths(const char* key, std::size_t count, double least,
                                         double most, const std::string& legal) const {
  std::vector<double> out;
  for (const ConfigNode& item : items(key, count, legal))
    out.push_back(read_length(item, path(key), least, most, units_));
  return out;
}

Pose FieldReader::pose(const char* key, double most, const std::string& legal) const {
  const std::vector<ConfigNode>& entries = items(key, 3, legal);
  return {read_length(entries[0], path(key), -most, most, units_),
          read_length(entries[1], path(key), -most, most, units_),
          read_angle(entries[2], path(key))};
}

double read_angle(const ConfigNode& node, const std::string& path) {
  constexpr double kFullTurn = 6.2832;  // 2 pi, rounded up
  const std::string legal = "an angle in rad, from -6.2832 to 6.2832";
  const double angle = read_number(node, path, legal);
  if (std::abs(angle) > kFullTurn)
    throw ConfigError(node.origin, path, node.scalar + " rad is more than a full turn", legal);
  return angle;
}

double read_number(const ConfigNode& node, const std::string& path, double least, double most,
                   const std::string& unit) {
  const std::string legal = range_text("a number", number_text(least), number_text(most), unit);
  const double number = read_number(node, path, legal);
  if (number < least || number > most)
    throw ConfigError(node.origin, path, node.scalar + " is out of range", legal);
  return number;
}

std::string length_range(double least, double most, const tasks::Units& units) {
  return range_text("a number", length_text(least, units), length_text(most, units), "m");
}

double read_length(const ConfigNode& node, const std::string& path, double least, double most,
                   const tasks::Units& units) {
  const std::string legal = length_range(least, most, units);
  const double metres = read_number(node, path, legal);
  const double length = units.length_of(metres);
  if (length < least || length > most)
    throw ConfigError(node.origin, path, node.scalar + " is out of range",
                      legal + (units.length == 1.0 ? "" : ", for a robot of this size"));
  return length;
}

std::string shortest_text(double number, const std::function<bool(double)>& is_right) {
  char buffer[32];
  for (int digits = 1; digits <= std::numeric_limits<double>::digits10; ++digits) {
    const auto [end, code] = std::to_chars(buffer, buffer + sizeof buffer, number,
                                           std::chars_format::scientific, digits - 1);
    double read = 0.0;
    std::from_chars(buffer, end, read);
    if (is_right(read)) return number_text(read);
  }
  return number_text(number);
}

std::string length_text(double x, const tasks::Units& units) {
  return shortest_text(x * units.length,
                       [&](double metres) { return units.length_of(metres) == x; });
}

std::string single_length_text(double x, const tasks::Units& units) {
  return shortest_text(x * units.length, [&](double metres) {
    return static_cast<float>(units.length_of(metres)) == static_cast<float>(x);
  });
}

std::string density_text(double x, const tasks::Units& units) {
  return shortest_text(x * units.density,
                       [&](double given) { return units.density_of(given) == x; });
}

std::string number_text(double number) { return shortest(number); }

std::string single_text(float number) { return shortest(number); }

std::string listed(std::span<const std::string> words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : ", ") + word;
  return out;
}

}  // namespace rtg::config

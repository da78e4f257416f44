#include "nodes/config/field_writer.hpp"

#include <utility>

namespace rtg::config {
namespace {

std::string with_range(const char* doc, const std::string& least, const std::string& most) {
  const std::string text = doc;
  return text + (text.empty() ? "" : "; ") + least + " to " + most;
}

}  // namespace

void FieldWriter::number(const char* key, double value, double least, double most,
                         const char* doc) {
  add(key, number_text(value), false, with_range(doc, number_text(least), number_text(most)));
}

void FieldWriter::length(const char* key, double value, double least, double most,
                         const char* doc) {
  add(key, length_text(value, units_), false,
      with_range(doc, length_text(least, units_), length_text(most, units_)));
}

void FieldWriter::integer(const char* key, int value, int least, int most, const char* doc) {
  add(key, std::to_string(value), false,
      with_range(doc, std::to_string(least), std::to_string(most)));
}

void FieldWriter::flag(const char* key, bool value, const char* doc) {
  add(key, value ? "true" : "false", false, doc);
}

void FieldWriter::text(const char* key, const std::string& value, const char* doc) {
  add(key, value, true, doc);
}

std::string FieldWriter::joined(std::span<const std::string_view> names) {
  std::string out;
  for (const std::string_view name : names) out += (out.empty() ? "" : ", ") + std::string(name);
  return out;
}

void FieldWriter::add(const char* key, std::string value, bool quoted, std::string comment) {
  ConfigNode node = token_node(std::move(value));
  node.quoted = quoted;
  section.entries.push_back({key, "", std::move(node), std::move(comment)});
}

}  // namespace rtg::config

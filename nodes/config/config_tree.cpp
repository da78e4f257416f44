#include "nodes/config/config_tree.hpp"

#include <algorithm>
#include <cctype>
#include <utility>

namespace rtg::config {
namespace {

using Kind = ConfigNode::Kind;

/// Returns `text` as a JSON string, which YAML reads as the same text.
std::string quote(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

/// Returns whether YAML reads `text` without quotes back as the same text.
bool is_plain_word(const std::string& text) {
  static const std::vector<std::string> kMeaning{"true", "false", "null", "Null", "NULL"};
  const auto in_word = [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; };
  return !text.empty() && std::isalpha(static_cast<unsigned char>(text[0])) &&
         std::all_of(text.begin(), text.end(), in_word) &&
         std::find(kMeaning.begin(), kMeaning.end(), text) == kMeaning.end();
}

std::string scalar_text(const ConfigNode& node) {
  return node.quoted && !is_plain_word(node.scalar) ? quote(node.scalar) : node.scalar;
}

std::string flow(const ConfigNode& node) {
  if (node.kind == Kind::kScalar) return scalar_text(node);
  std::string out;
  const auto join = [&out](const std::string& text) { out += (out.empty() ? "" : ", ") + text; };
  if (node.kind == Kind::kList) {
    for (const ConfigNode& item : node.items) join(flow(item));
    return '[' + out + ']';
  }
  for (const ConfigEntry& entry : node.entries) join(entry.key + ": " + flow(entry.value));
  return '{' + out + '}';
}

bool is_block(const ConfigNode& node) {
  if (node.kind == Kind::kList)
    return std::any_of(node.items.begin(), node.items.end(),
                       [](const ConfigNode& item) { return item.kind == Kind::kMap; });
  return std::any_of(node.entries.begin(), node.entries.end(), [](const ConfigEntry& entry) {
    return !entry.comment.empty() || is_block(entry.value);
  });
}

std::string block(const ConfigNode& node, const std::string& indent) {
  std::string out;
  for (const ConfigNode& item : node.items) out += indent + "- " + flow(item) + '\n';
  for (const ConfigEntry& entry : node.entries) {
    const std::string comment = entry.comment.empty() ? "" : "  # " + entry.comment;
    out += indent + entry.key + ':';
    out += is_block(entry.value) ? comment + '\n' + block(entry.value, indent + "  ")
                                 : ' ' + flow(entry.value) + comment + '\n';
  }
  return out;
}

std::string json(const ConfigNode& node, const std::string& indent) {
  if (node.kind == Kind::kScalar) return node.quoted ? quote(node.scalar) : node.scalar;
  const std::string deeper = indent + "  ";
  std::string out;
  const auto join = [&](const std::string& text) {
    out += (out.empty() ? "\n" : ",\n") + deeper + text;
  };
  for (const ConfigNode& item : node.items) join(json(item, deeper));
  for (const ConfigEntry& entry : node.entries)
    join(quote(entry.key) + ": " + json(entry.value, deeper));
  const bool is_list = node.kind == Kind::kList;
  return (is_list ? '[' : '{') + out + '\n' + indent + (is_list ? ']' : '}');
}

/// Returns `text`, cut off after at most 60 bytes but never inside a UTF-8 character.
std::string shortened(const std::string& text) {
  std::size_t size = 60;
  if (text.size() <= size) return text;
  while (size > 0 && (static_cast<unsigned char>(text[size]) & 0xc0) == 0x80) --size;
  return text.substr(0, size) + "...";
}

}  // namespace

ConfigNode text_node(std::string text) {
  ConfigNode node = token_node(std::move(text));
  node.quoted = true;
  return node;
}

ConfigNode token_node(std::string token) {
  ConfigNode node;
  node.kind = Kind::kScalar;
  node.scalar = std::move(token);
  return node;
}

ConfigNode list_node(std::vector<ConfigNode> items) {
  ConfigNode node;
  node.kind = Kind::kList;
  node.items = std::move(items);
  return node;
}

ConfigNode map_node(std::string origin) {
  ConfigNode node;
  node.kind = Kind::kMap;
  node.origin = std::move(origin);
  return node;
}

ConfigNode mapping(std::vector<ConfigEntry> entries) {
  ConfigNode node = map_node();
  node.entries = std::move(entries);
  return node;
}

std::string in_words(const ConfigNode& node) {
  switch (node.kind) {
    case Kind::kNull:
      return "nothing";
    case Kind::kScalar:
      return '\'' + shortened(node.scalar) + '\'';
    case Kind::kList:
      return "a list";
    case Kind::kMap:
      return "a mapping";
  }
  return "";
}

std::string yaml_text(const ConfigNode& root) { return block(root, ""); }

std::string json_text(const ConfigNode& root) { return json(root, "") + '\n'; }

}  // namespace rtg::config

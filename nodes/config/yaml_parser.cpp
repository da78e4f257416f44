#include "nodes/config/yaml_parser.hpp"

#include <utf8cpp/utf8.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <functional>
#include <sstream>
#include <utility>

#include "nodes/config/config_error.hpp"

namespace rtg::config {
namespace {

constexpr std::size_t kMaxDepth = 16;

using OriginOfLine = std::function<std::string(int)>;  // lines count from 0

/// Builds a ConfigNode tree from the parser's events. Throws ConfigError for YAML that is not
/// accepted.
class TreeBuilder : public YAML::EventHandler {
 public:
  explicit TreeBuilder(OriginOfLine origin) : origin_(std::move(origin)) {}

  ConfigNode root;

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    add(node(ConfigNode::Kind::kNull, mark, "?", anchor));
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    refuse(mark.line, "an alias (*) is not allowed", "every value written out");
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    ConfigNode scalar = node(ConfigNode::Kind::kScalar, mark, tag, anchor);
    scalar.scalar = value;
    scalar.quoted = tag == "!";
    add(std::move(scalar));
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(node(ConfigNode::Kind::kList, mark, tag, anchor));
  }
  void OnSequenceEnd() override { close(); }

  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(node(ConfigNode::Kind::kMap, mark, tag, anchor));
  }
  void OnMapEnd() override { close(); }

 private:
  struct Level {
    ConfigNode node;
    bool has_key = false;
    std::string key = {}, key_origin = {};
  };

  [[noreturn]] void refuse(int line, const std::string& what, const std::string& legal) const {
    throw ConfigError(origin_(line) + ": " + what + "; legal: " + legal);
  }

  ConfigNode node(ConfigNode::Kind kind, const YAML::Mark& mark, const std::string& tag,
                  YAML::anchor_t anchor) const {
    if (anchor != 0) refuse(mark.line, "an anchor (&) is not allowed", "every value written out");
    if (!tag.empty() && tag != "?" && tag != "!")
      refuse(mark.line, "a tag (!) is not allowed", "plain values");
    ConfigNode made;
    made.kind = kind;
    made.origin = origin_(mark.line);
    return made;
  }

  void open(ConfigNode container) {
    if (levels_.size() == kMaxDepth)
      throw ConfigError(container.origin + ": the text is nested too deep; legal: at most " +
                        std::to_string(kMaxDepth) + " levels");
    levels_.push_back({std::move(container)});
  }

  void close() {
    ConfigNode done = std::move(levels_.back().node);
    levels_.pop_back();
    add(std::move(done));
  }

  void add(ConfigNode value) {
    if (levels_.empty()) {
      root = std::move(value);
    } else if (Level& level = levels_.back(); level.node.kind == ConfigNode::Kind::kList) {
      level.node.items.push_back(std::move(value));
    } else if (level.has_key) {
      if (value.kind == ConfigNode::Kind::kNull) value.origin = level.key_origin;
      level.node.entries.push_back({level.key, level.key_origin, std::move(value)});
      level.has_key = false;
    } else {
      take_key(level, value);
    }
  }

  /// Returns the dotted key of the innermost level with a trailing dot; "" at the root.
  std::string path() const {
    std::string out;
    for (std::size_t k = 0; k + 1 < levels_.size(); ++k) {
      const Level& level = levels_[k];
      const bool is_list = level.node.kind == ConfigNode::Kind::kList;
      out += (is_list ? std::to_string(level.node.items.size()) : level.key) + '.';
    }
    return out;
  }

  void take_key(Level& level, const ConfigNode& key) const {
    if (key.kind != ConfigNode::Kind::kScalar)
      throw ConfigError(key.origin + ": " + in_words(key) + " cannot be a key; legal: a word");
    if (const ConfigEntry* first = find(level.node, key.scalar))
      throw ConfigError(key.origin, path() + key.scalar,
                        "is given twice, first at " + first->origin, "once");
    level.has_key = true;
    level.key = key.scalar;
    level.key_origin = key.origin;
  }

  OriginOfLine origin_;
  std::vector<Level> levels_;
};

void check_utf8(const std::string& text, const OriginOfLine& origin) {
  const auto wrong = utf8::find_invalid(text.begin(), text.end());
  if (wrong == text.end()) return;
  const auto line = static_cast<int>(std::count(text.begin(), wrong, '\n'));
  throw ConfigError(origin(line) + ": has a byte that is not UTF-8; legal: text in UTF-8");
}

ConfigNode parse(const std::string& text, const OriginOfLine& origin) {
  if (text.size() > kMaxYamlBytes)
    throw ConfigError(origin(0) + ": the text is too long; legal: at most " +
                      std::to_string(kMaxYamlBytes) + " bytes");
  check_utf8(text, origin);
  std::istringstream stream(text);
  TreeBuilder builder(origin);
  try {
    YAML::Parser parser(stream);
    parser.HandleNextDocument(builder);
    ConfigNode root = std::move(builder.root);
    TreeBuilder rest(origin);
    if (parser.HandleNextDocument(rest))
      throw ConfigError(rest.root.origin +
                        ": a second document is not allowed; legal: one document");
    return root;
  } catch (const YAML::Exception& error) {
    throw ConfigError(origin(error.mark.line) + ": is not valid YAML: " + error.msg +
                      "; legal: YAML, 'key: value' on each line, indented by spaces");
  }
}

}  // namespace

ConfigNode parse_yaml(const std::string& text, const std::string& file) {
  return parse(text, [&file](int line) { return file + ":" + std::to_string(line + 1); });
}

ConfigNode parse_yaml_value(const std::string& text, const std::string& flag) {
  return parse(text, [&flag](int) { return flag; });
}

}  // namespace rtg::config

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <string_view>

#include "core/math/rng.hpp"
#include "nodes/common/rtg_config.hpp"
#include "tests/nodes/two_boxes.hpp"

namespace rtg {
namespace {

constexpr int kTexts = 3000;

constexpr std::array<std::string_view, 30> kTokens{
    "[",  "]",     "{",    "}",  ": ", ", ",    "\n",   "\n  - ", "- ",   "'",
    "\"", "#",     "&a ",  "*a", "!",  "!!int", "---",  "...",    "? ",   "| ",
    "> ", "1e999", ".nan", "-1", "0",  "\t",    "\xff", "\\",     "true", "%YAML 1.2\n"};

std::size_t place(const std::string& text, Rng& rng) {
  return static_cast<std::size_t>(rng.below(static_cast<int>(text.size()) + 1));
}

/// One random edit: a byte changed, a token put in, a stretch left out or doubled, two lines
/// swapped for one another's tails.
void mutate(std::string& text, Rng& rng) {
  const std::size_t at = place(text, rng);
  const auto length = static_cast<std::size_t>(rng.below(40));
  switch (rng.below(4)) {
    case 0:
      if (at < text.size()) text[at] = static_cast<char>(rng.below(256));
      break;
    case 1:
      text.insert(at, kTokens[static_cast<std::size_t>(rng.below(kTokens.size()))]);
      break;
    case 2:
      text.erase(at, length);
      break;
    default:
      text.insert(place(text, rng), text.substr(at, length));
  }
}

/// Loads the text. A legal one must have a canonical text that reads back to itself; what is wrong
/// with another must be said in one line that names what is legal.
bool is_legal(const std::string& text) {
  try {
    const std::string canonical = canonical_yaml(parse_config(text, "fuzz.yaml"));
    EXPECT_EQ(canonical_yaml(parse_config(canonical, "canonical.yaml")), canonical) << text;
    return true;
  } catch (const ConfigError& error) {
    const std::string message = error.what();
    EXPECT_TRUE(message.starts_with("fuzz.yaml:")) << message << '\n' << text;
    EXPECT_NE(message.find("; legal: "), std::string::npos) << message << '\n' << text;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message << '\n' << text;
    return false;
  }
}

TEST(ConfigFuzz, MutatedTextsAreReadOrRefusedInOneLine) {
  const std::string whole = canonical_yaml(parse_config(testing::kTwoBoxes, "two_boxes.yaml"));
  Rng rng(20);
  int legal = 0;
  for (int k = 0; k < kTexts; ++k) {
    std::string text = k % 4 == 0 ? whole : testing::kTwoBoxes;
    for (int edits = 1 + rng.below(4); edits > 0; --edits) mutate(text, rng);
    legal += is_legal(text) ? 1 : 0;
  }
  // Neither nearly all nor nearly none, or the edits would test nothing.
  EXPECT_GT(legal, kTexts / 20);
  EXPECT_LT(legal, kTexts * 19 / 20);
}

TEST(ConfigFuzz, MutatedSettingsAreReadOrRefusedInOneLine) {
  Rng rng(21);
  for (int k = 0; k < kTexts; ++k) {
    std::string setting = k % 2 == 0 ? "task.bodies.1.start=[3, 0, 0.5]" : "search.breadth=32";
    for (int edits = 1 + rng.below(3); edits > 0; --edits) mutate(setting, rng);
    try {
      parse_config(testing::kTwoBoxes, "two_boxes.yaml", std::array{setting});
    } catch (const ConfigError& error) {
      EXPECT_NE(std::string(error.what()).find("; legal: "), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace rtg

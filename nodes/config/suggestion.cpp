#include "nodes/config/suggestion.hpp"

#include <algorithm>
#include <numeric>
#include <string_view>
#include <utility>
#include <vector>

namespace rtg::config {
namespace {

constexpr std::size_t kLongest = 40;  // characters of a word for which others are tried

/// Keys as users may call them, and their names here. Of a name with a dot, the section is a word.
constexpr std::pair<std::string_view, std::string_view> kSynonyms[] = {
    {"tolerance", "within"}, {"circle", "disc"},          {"angle", "theta"},
    {"rectangle", "box"},    {"polygon", "vertices"},     {"stride", "push.stride"},
    {"arena", "push.arena"}, {"strides", "push.strides"}, {"headings", "push.headings"}};

/// Returns the Levenshtein distance of two texts.
std::size_t edits(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0u);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = std::exchange(row[j], std::min({row[j] + 1, row[j - 1] + 1, replaced}));
    }
  }
  return row.back();
}

}  // namespace

std::string suggestion(const std::string& word, std::span<const std::string> words) {
  if (words.empty() || word.empty() || word.size() > kLongest) return "";
  for (const auto& [called, name] : kSynonyms)
    if (called == word && std::ranges::count(words, name.substr(0, name.find('.'))))
      return " (did you mean '" + std::string(name) + "'?)";
  const auto nearest = std::min_element(
      words.begin(), words.end(),
      [&](const auto& a, const auto& b) { return edits(word, a) < edits(word, b); });
  const std::size_t near = std::min(std::max<std::size_t>(2, word.size() / 3), word.size() - 1);
  return edits(word, *nearest) <= near ? " (did you mean '" + *nearest + "'?)" : "";
}

}  // namespace rtg::config

#pragma once

#include <span>
#include <string>

namespace rtg::config {

/// Returns " (did you mean 'x'?)" for the one of `words` most similar to `word` in meaning or
/// letters, or "" if none is similar.
std::string suggestion(const std::string& word, std::span<const std::string> words);

}  // namespace rtg::config

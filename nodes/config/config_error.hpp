#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace rtg::config {

/// An error in the configuration. It makes a program end with exit status 2. what() is one line for
/// the user:
///
///   FILE:LINE: key 'search.breadth': what is wrong; legal: what would be right
///
/// If a flag `--set KEY=VALUE` gave the wrong value, the flag replaces FILE:LINE. If a flag made
/// another value illegal, the flag precedes FILE:LINE of that value.
class ConfigError : public std::runtime_error {
 public:
  explicit ConfigError(std::string line) : std::runtime_error(printable(std::move(line))) {}

  ConfigError(const std::string& origin, const std::string& key, const std::string& wrong,
              const std::string& legal)
      : ConfigError(origin + ": key '" + key + "': " + wrong + "; legal: " + legal) {}

 private:
  /// Replaces control characters by spaces, because quotations from a file may contain some.
  static std::string printable(std::string line) {
    for (char& c : line)
      if ((c >= 0 && c < ' ') || c == '\x7f') c = ' ';
    return line;
  }
};

}  // namespace rtg::config

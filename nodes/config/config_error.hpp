#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace rtg::config {

/// A mistake in the configuration; what() is one line for its writer, who gets exit status 2:
///
///   FILE:LINE: key 'search.breadth': what is wrong; legal: what would be right
///
/// with the flag, `--set KEY=VALUE`, in the place of FILE:LINE if that is where it was given, and
/// before it if the flag made wrong what the file says there.
class ConfigError : public std::runtime_error {
 public:
  explicit ConfigError(std::string line) : std::runtime_error(printable(std::move(line))) {}

  ConfigError(const std::string& origin, const std::string& key, const std::string& wrong,
              const std::string& legal)
      : ConfigError(origin + ": key '" + key + "': " + wrong + "; legal: " + legal) {}

 private:
  /// Quotations from a file may hold line ends or worse.
  static std::string printable(std::string line) {
    for (char& c : line)
      if ((c >= 0 && c < ' ') || c == '\x7f') c = ' ';
    return line;
  }
};

}  // namespace rtg::config

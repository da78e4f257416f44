#pragma once

#include <stdexcept>
#include <string>

namespace rtg {

/// A mistake in the configuration; what() is one line for its writer, who gets exit status 2:
///
///   FILE:LINE: key 'search.breadth': what is wrong; legal: what would be right
///
/// with the flag, `--set KEY=VALUE`, in the place of FILE:LINE if that is where it was given.
class ConfigError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;

  ConfigError(const std::string& origin, const std::string& key, const std::string& wrong,
              const std::string& legal)
      : std::runtime_error(origin + ": key '" + key + "': " + wrong + "; legal: " + legal) {}
};

}  // namespace rtg

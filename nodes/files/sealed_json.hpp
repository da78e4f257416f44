#pragma once

#include <string>

namespace rtg::files {

/// Returns a JSON object, not empty, with a last member "sha256": the SHA-256 of all bytes before
/// its digits. Python's run_folder.read_json() checks it.
std::string sealed_json(std::string object);

}  // namespace rtg::files

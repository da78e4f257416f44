#pragma once

#include <filesystem>
#include <string>

namespace rtg {

/// Writes `text` to `path` at once or not at all. Throws std::system_error that names the file.
void write_whole_file(const std::filesystem::path& path, const std::string& text);

}  // namespace rtg

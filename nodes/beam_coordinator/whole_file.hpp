#pragma once

#include <filesystem>
#include <string>

namespace rtg::beam_coordinator {

/// Writes `text` to `path` at once or not at all, also if the machine goes down. Throws
/// std::system_error that names the file.
void write_whole_file(const std::filesystem::path& path, const std::string& text);

}  // namespace rtg::beam_coordinator

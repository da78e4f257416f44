#pragma once

#include <filesystem>
#include <string>

namespace rtg::beam_coordinator {

/// Writes `text` to `path` completely or not at all, even if the machine crashes. Throws
/// std::system_error that names the file.
void write_atomically(const std::filesystem::path& path, const std::string& text);

}  // namespace rtg::beam_coordinator

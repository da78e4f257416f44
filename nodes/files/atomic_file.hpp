#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>

namespace rtg::files {

/// Writes `text` to `path` completely or not at all, even if the machine crashes. A new file gets
/// the permissions `mode`, less those of the umask. Throws std::system_error that names the file;
/// if only its folder could not be synced, the file is there, but may be gone after a power cut.
void write_atomically(const std::filesystem::path& path, const std::string& text,
                      mode_t mode = 0666);

}  // namespace rtg::files

#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace rtg::files {

/// What read_regular() found.
struct Content {
  std::string text;
  std::string defect;  // why it cannot be read, as in "no such file"; empty if it could
};

/// Who may be able to read a file.
enum class Readers { kAnyone, kOwnerAlone };

/// Reads a regular file of at most `most` bytes: no device, which may never end, and no FIFO, which
/// may never begin. With kOwnerAlone it has to be this user's and closed to all others.
Content read_regular(const std::filesystem::path& path, std::size_t most,
                     Readers readers = Readers::kAnyone);

}  // namespace rtg::files

#include "nodes/beam_coordinator/atomic_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <system_error>

namespace rtg::beam_coordinator {
namespace {

/// Flushes the file to disk, so that it survives a power cut. Returns whether that succeeded.
bool is_on_disk(const std::filesystem::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return false;
  const bool synced = ::fsync(file) == 0;
  return ::close(file) == 0 && synced;
}

}  // namespace

void write_atomically(const std::filesystem::path& path, const std::string& text) {
  std::filesystem::path part = path;
  part += ".part";
  std::ofstream file(part, std::ios::binary);
  file << text;
  file.close();
  if (!file || !is_on_disk(part)) {
    const std::error_code cause(errno, std::generic_category());
    std::error_code ignored;
    std::filesystem::remove(part, ignored);
    throw std::system_error(cause, path.string() + " cannot be written");
  }
  std::filesystem::rename(part, path);
}

}  // namespace rtg::beam_coordinator

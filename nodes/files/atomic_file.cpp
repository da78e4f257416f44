#include "nodes/files/atomic_file.hpp"

#include <cerrno>
#include <cstddef>
#include <system_error>

#include "nodes/files/descriptor.hpp"

namespace rtg::files {
namespace {

/// Writes `text` to a new file that survives a power cut. Returns false and sets errno if it could
/// not.
bool write_new(const std::filesystem::path& path, const std::string& text, mode_t mode) {
  Descriptor file(path, O_WRONLY | O_CREAT | O_EXCL, mode);
  if (!file) return false;
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t written = ::write(file.number(), text.data() + done, text.size() - done);
    if (written < 0 && errno != EINTR) return false;
    if (written > 0) done += static_cast<std::size_t>(written);
  }
  return ::fsync(file.number()) == 0 && file.close();
}

/// Makes the names in `folder` survive a power cut. Returns false and sets errno if it could not.
bool sync_names(const std::filesystem::path& folder) {
  Descriptor names(folder.empty() ? "." : folder, O_RDONLY | O_DIRECTORY);
  return names && ::fsync(names.number()) == 0 && names.close();
}

}  // namespace

void write_atomically(const std::filesystem::path& path, const std::string& text, mode_t mode) {
  std::filesystem::path part = path;
  part += ".part";
  ::unlink(part.c_str());  // a killed writer left it
  if (write_new(part, text, mode) && ::rename(part.c_str(), path.c_str()) == 0 &&
      sync_names(path.parent_path()))
    return;
  const std::error_code cause(errno, std::generic_category());
  ::unlink(part.c_str());
  throw std::system_error(cause, path.string() + " cannot be written");
}

}  // namespace rtg::files

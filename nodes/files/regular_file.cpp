#include "nodes/files/regular_file.hpp"

#include <sys/stat.h>

#include <cerrno>
#include <system_error>

#include "nodes/files/descriptor.hpp"

namespace rtg::files {
namespace {

std::string in_words(int error) {
  if (error == ENOENT) return "no such file";
  return "cannot be read: " + std::generic_category().message(error);
}

/// Returns why a file of this status is not to be read; empty if it is.
std::string defect_of(const struct stat& status, std::size_t most, Readers readers) {
  if (S_ISDIR(status.st_mode)) return "is a folder";
  if (!S_ISREG(status.st_mode)) return "is no regular file";
  if (static_cast<std::size_t>(status.st_size) > most)
    return "is longer than " + std::to_string(most) + " bytes";
  if (readers == Readers::kOwnerAlone && (status.st_uid != geteuid() || (status.st_mode & 077)))
    return "others can read or write it, or it is another user's (chmod 600 closes it)";
  return "";
}

}  // namespace

Content read_regular(const std::filesystem::path& path, std::size_t most, Readers readers) {
  const Descriptor file(path, O_RDONLY | O_NONBLOCK);  // else open() of a FIFO waits
  struct stat status {};
  if (!file || ::fstat(file.number(), &status) != 0) return {"", in_words(errno)};
  if (std::string defect = defect_of(status, most, readers); !defect.empty()) return {"", defect};
  std::string text(static_cast<std::size_t>(status.st_size), '\0');
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t size = ::read(file.number(), text.data() + done, text.size() - done);
    if (size < 0 && errno == EINTR) continue;
    if (size < 0) return {"", in_words(errno)};
    if (size == 0) break;  // it has been cut meanwhile
    done += static_cast<std::size_t>(size);
  }
  text.resize(done);
  return {text, ""};
}

}  // namespace rtg::files

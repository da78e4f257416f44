#include "nodes/common/whole_file.hpp"

#include <cerrno>
#include <fstream>
#include <system_error>

namespace rtg {

void write_whole_file(const std::filesystem::path& path, const std::string& text) {
  std::filesystem::path part = path;
  part += ".part";
  std::ofstream file(part, std::ios::binary);
  file << text;
  file.close();
  if (!file) {
    const std::error_code cause(errno, std::generic_category());
    std::error_code ignored;
    std::filesystem::remove(part, ignored);
    throw std::system_error(cause, path.string() + " cannot be written");
  }
  std::filesystem::rename(part, path);
}

}  // namespace rtg

#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <filesystem>
#include <span>
#include <string>

#include "nodes/files/descriptor.hpp"
#include "tests/fuzz/target.hpp"

namespace rtg::fuzz {

/// A file of this process alone that its user alone can read; it is removed in the end.
struct ScratchFile {
  std::filesystem::path path;

  explicit ScratchFile(const std::string& name)
      : path(folder() / ("rtg_fuzz." + std::to_string(getpid()) + "." + name)) {}
  ~ScratchFile() { std::filesystem::remove(path); }
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  /// Makes `bytes` its content.
  void write(std::span<const std::uint8_t> bytes) const { put(bytes, O_TRUNC); }

  /// Puts `bytes` behind its content.
  void append(std::span<const std::uint8_t> bytes) const { put(bytes, O_APPEND); }

 private:
  void put(std::span<const std::uint8_t> bytes, int flag) const {
    const files::Descriptor file(path, O_WRONLY | O_CREAT | flag, 0600);
    require(file && ::write(file.number(), bytes.data(), bytes.size()) ==
                        static_cast<ssize_t>(bytes.size()),
            "the scratch file can be written");
  }

  /// Memory, if there is such a folder: a disk would be the slowest part of a target.
  static std::filesystem::path folder() {
    const std::filesystem::path memory = "/dev/shm";
    return std::filesystem::is_directory(memory) ? memory : std::filesystem::temp_directory_path();
  }
};

}  // namespace rtg::fuzz

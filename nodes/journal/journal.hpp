#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <stdexcept>
#include <unordered_map>
#include <vector>

#include "nodes/files/descriptor.hpp"

namespace rtg::journal {

/// A journal that cannot be opened or written. The message names its file.
class JournalError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A file of records that grows at its end. A record is an id and up to kMaxBytes bytes. One
/// process at a time may have it open, and one thread at a time may use it.
///
/// append() returns when the kernel has the record. So the death of the process loses none of them.
/// A power cut may lose the last ones, as nothing is flushed to the disk; what is left is whole.
///
/// The file begins with the eight characters RTGJRNL1 and the identity, 8 bytes. A record has the
/// number n of its bytes (4 bytes), the id (8), the n bytes, and a SHA-256 (32), which covers the
/// identity, n, the id and the bytes. Numbers are little-endian.
class Journal {
 public:
  static constexpr std::size_t kMaxBytes = 1 << 16;

  /// Opens `path`, or makes the file. Keeps its records up to the first one that is torn or damaged
  /// and cuts off the rest. Begins anew if the file is no journal, or that of another `identity`.
  /// Throws JournalError if it is no regular file, is open elsewhere, or cannot be read or written.
  Journal(std::filesystem::path path, std::int64_t identity);

  /// Adds a record, which replaces an earlier one of that id. Throws JournalError if it cannot be
  /// written; the records before it stay. Throws std::length_error beyond kMaxBytes.
  void append(std::int64_t id, std::span<const std::uint8_t> bytes);

  /// Returns the bytes of record `id`; nothing if there is none, or it has been damaged since.
  std::optional<std::vector<std::uint8_t>> find(std::int64_t id) const;

  /// Returns the number of different ids.
  std::size_t size() const { return places_.size(); }
  /// Returns how many bytes of the file the constructor has cut off.
  std::int64_t dropped_bytes() const { return dropped_bytes_; }

 private:
  struct Record {
    std::int64_t id = 0;
    std::vector<std::uint8_t> bytes;
  };

  bool begin();
  void cut();
  std::optional<Record> record_at(std::int64_t place) const;
  bool read(std::int64_t place, std::span<std::uint8_t> bytes) const;
  void write(std::span<const std::uint8_t> bytes);
  [[noreturn]] void fail(const std::string& what) const;

  std::filesystem::path path_;
  std::vector<std::uint8_t> identity_;  // as in the file
  files::Descriptor file_;
  std::int64_t end_ = 0;  // of the last record
  std::int64_t dropped_bytes_ = 0;
  std::unordered_map<std::int64_t, std::int64_t> places_;  // of records in the file, by id
};

}  // namespace rtg::journal

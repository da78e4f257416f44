#include "nodes/journal/journal.hpp"

#include <sys/file.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

#include "nodes/files/sha256.hpp"

namespace rtg::journal {
namespace {

constexpr std::array<std::uint8_t, 8> kMagic{'R', 'T', 'G', 'J', 'R', 'N', 'L', '1'};
constexpr std::size_t kHeadBytes = 4 + 8;  // number of bytes, id
constexpr std::size_t kDigestBytes = files::Sha256::kBytes;

template <class Word>
void append_word(std::vector<std::uint8_t>& out, Word word) {
  for (std::size_t k = 0; k < sizeof(Word); ++k)
    out.push_back(static_cast<std::uint8_t>(static_cast<std::uint64_t>(word) >> 8 * k));
}

template <class Word>
Word word_at(std::span<const std::uint8_t> bytes) {
  std::uint64_t word = 0;
  for (std::size_t k = 0; k < sizeof(Word); ++k) word |= std::uint64_t{bytes[k]} << 8 * k;
  return static_cast<Word>(word);
}

auto digest_of(std::span<const std::uint8_t> identity, std::span<const std::uint8_t> record) {
  return files::Sha256().add(identity).add(record).digest();
}

std::vector<std::uint8_t> bytes_of(std::int64_t word) {
  std::vector<std::uint8_t> bytes;
  append_word(bytes, word);
  return bytes;
}

}  // namespace

Journal::Journal(std::filesystem::path path, std::int64_t identity)
    : path_(std::move(path)),
      identity_(bytes_of(identity)),
      file_(path_, O_RDWR | O_CREAT | O_NOFOLLOW | O_NONBLOCK, 0666) {
  struct stat status {};
  if (!file_ || ::fstat(file_.number(), &status) != 0)
    fail("cannot be opened: " + std::generic_category().message(errno));
  if (!S_ISREG(status.st_mode)) fail("is no regular file");
  if (::flock(file_.number(), LOCK_EX | LOCK_NB) != 0) fail("another process has it open");
  const bool is_ours = begin();
  while (const std::optional<Record> record = record_at(end_)) {
    places_[record->id] = end_;
    end_ += static_cast<std::int64_t>(kHeadBytes + record->bytes.size() + kDigestBytes);
  }
  dropped_bytes_ = is_ours ? status.st_size - end_ : status.st_size;
  cut();
}

void Journal::append(std::int64_t id, std::span<const std::uint8_t> bytes) {
  if (bytes.size() > kMaxBytes) throw std::length_error("a record that is too long for a journal");
  std::vector<std::uint8_t> record;
  append_word(record, static_cast<std::uint32_t>(bytes.size()));
  append_word(record, id);
  record.insert(record.end(), bytes.begin(), bytes.end());
  const auto digest = digest_of(identity_, record);
  record.insert(record.end(), digest.begin(), digest.end());
  const std::int64_t place = end_;
  write(record);
  places_[id] = place;
}

std::optional<std::vector<std::uint8_t>> Journal::find(std::int64_t id) const {
  const auto place = places_.find(id);
  if (place == places_.end()) return std::nullopt;
  std::optional<Record> record = record_at(place->second);
  if (!record || record->id != id) return std::nullopt;
  return std::move(record->bytes);
}

/// Sets the end to that of the head of the file. If that is not there, empties the file, writes it
/// and returns false.
bool Journal::begin() {
  std::vector<std::uint8_t> head(kMagic.begin(), kMagic.end());
  head.insert(head.end(), identity_.begin(), identity_.end());
  std::vector<std::uint8_t> found(head.size());
  if (read(0, found) && found == head) {
    end_ = static_cast<std::int64_t>(head.size());
    return true;
  }
  cut();
  write(head);
  return false;
}

/// Cuts off what is behind the end.
void Journal::cut() {
  if (::ftruncate(file_.number(), end_) != 0)
    fail("cannot be written: " + std::generic_category().message(errno));
}

/// Returns the record that begins at `place`; nothing if none is whole there.
std::optional<Journal::Record> Journal::record_at(std::int64_t place) const {
  std::vector<std::uint8_t> bytes(kHeadBytes);
  if (!read(place, bytes)) return std::nullopt;
  const std::size_t size = word_at<std::uint32_t>(bytes);
  if (size > kMaxBytes) return std::nullopt;
  bytes.resize(kHeadBytes + size + kDigestBytes);
  if (!read(place, bytes)) return std::nullopt;
  const auto record = std::span(bytes).first(kHeadBytes + size);
  if (!std::ranges::equal(digest_of(identity_, record), std::span(bytes).last(kDigestBytes)))
    return std::nullopt;
  const auto id = word_at<std::int64_t>(std::span(bytes).subspan(4));
  return Record{id, {record.begin() + kHeadBytes, record.end()}};
}

/// Fills `bytes` with those from `place` on. Returns false if the file ends before.
bool Journal::read(std::int64_t place, std::span<std::uint8_t> bytes) const {
  while (!bytes.empty()) {
    const ssize_t size = ::pread(file_.number(), bytes.data(), bytes.size(), place);
    if (size < 0 && errno == EINTR) continue;
    if (size < 0) fail("cannot be read: " + std::generic_category().message(errno));
    if (size == 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(size));
    place += size;
  }
  return true;
}

/// Writes `bytes` at the end, which it moves.
void Journal::write(std::span<const std::uint8_t> bytes) {
  std::int64_t place = end_;
  while (!bytes.empty()) {
    const ssize_t size = ::pwrite(file_.number(), bytes.data(), bytes.size(), place);
    if (size < 0 && errno == EINTR) continue;
    if (size < 0) fail("cannot be written: " + std::generic_category().message(errno));
    bytes = bytes.subspan(static_cast<std::size_t>(size));
    place += size;
  }
  end_ = place;
}

void Journal::fail(const std::string& what) const {
  throw JournalError(path_.string() + ": " + what);
}

}  // namespace rtg::journal

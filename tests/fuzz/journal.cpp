// A journal on disk: any file, and records with the right digests that hold any bytes.
#include "nodes/journal/journal.hpp"

#include <algorithm>

#include "nodes/files/regular_file.hpp"
#include "nodes/jobs/unit_journal.hpp"
#include "tests/fuzz/reverse_results.hpp"
#include "tests/fuzz/scratch_file.hpp"
#include "tests/fuzz/target.hpp"

namespace rtg::fuzz {
namespace {

constexpr std::int64_t kIdentity = 7;
constexpr jobs::TaskShape kShape{.bodies = 2, .actions = 4};
constexpr std::size_t kMostRecords = 16;

/// A file of its own for each use, as a journal cannot be opened twice.
const ScratchFile& file() {
  static const ScratchFile scratch("journal");
  return scratch;
}

/// Appends `bytes` as records 0, 1, ..., each of them behind its length in two bytes. Returns what
/// is left.
std::span<const std::uint8_t> append_records(journal::Journal& journal,
                                             std::span<const std::uint8_t> bytes,
                                             std::vector<Bytes>& records) {
  while (bytes.size() >= 2 && records.size() < kMostRecords) {
    const std::size_t length = bytes[0] + 256U * bytes[1];
    if (length > bytes.size() - 2) break;
    const auto record = bytes.subspan(2, length);
    records.emplace_back(record.begin(), record.end());
    journal.append(static_cast<std::int64_t>(records.size()) - 1, record);
    bytes = bytes.subspan(2 + length);
  }
  return bytes;
}

/// Requires that any file can be opened, keeps what is added to it, and answers units or not.
void check_file(std::span<const std::uint8_t> bytes) {
  file().write(bytes);
  std::size_t found = 0;
  {
    journal::Journal journal(file().path, kIdentity);
    found = journal.size();
    journal.append(-1, bytes.first(std::min(bytes.size(), journal::Journal::kMaxBytes)));
  }
  const journal::Journal journal(file().path, kIdentity);
  require(journal.size() == found || journal.size() == found + 1, "no record is lost");
  require(journal.find(-1).has_value(), "what was added is found");
}

/// Requires that records are kept, whatever stands behind the last one: libFuzzer sees what a
/// digest is compared with, so that it makes whole records there, too.
void check_records(std::span<const std::uint8_t> bytes) {
  file().write({});
  std::vector<Bytes> records;
  Bytes torn;
  {
    journal::Journal journal(file().path, kIdentity);
    const auto rest = append_records(journal, bytes, records);
    torn.assign(rest.begin(), rest.end());
  }
  file().append(torn);
  jobs::UnitJournal units(file().path, kIdentity);
  require(units.size() >= records.size(), "all records are there");
  for (std::size_t id = 0; id < records.size(); ++id)
    for (const std::size_t jobs : {1U, 3U}) {
      const auto key = static_cast<jobs::JobId>(id);
      const auto solved = units.find<jobs::ReverseService>(key, jobs, kShape);
      require(!solved || solved->empty() || solved->size() == jobs, "a unit has its results");
      const auto replayed = units.find<jobs::ReplayService>(key, jobs, kShape);
      require(!replayed || replayed->empty() || replayed->size() == jobs, "a unit has its results");
      require(!torn.empty() || records[id].empty() == (solved && solved->empty()),
              "no bytes: it was given up");
    }
}

void append_record(Bytes& out, const Bytes& record) {
  out.push_back(static_cast<std::uint8_t>(record.size()));
  out.push_back(static_cast<std::uint8_t>(record.size() >> 8));
  out.insert(out.end(), record.begin(), record.end());
}

Bytes solutions() {
  auto message = jobs::ReverseService::message(reverse_results());
  return bus::encode(message);
}

Bytes replays() {
  const std::vector<search::ReplayResult> results(3, {Poses(2), true, 0.1});
  auto message = jobs::ReplayService::message(results);
  return bus::encode(message);
}

}  // namespace

std::vector<Bytes> seeds() {
  Bytes records{1};
  for (const Bytes& record : {solutions(), Bytes{}, replays()}) append_record(records, record);
  file().write({});
  {
    journal::Journal journal(file().path, kIdentity);
    journal.append(5, Bytes{1, 2, 3});
    journal.append(5, Bytes{});
  }
  Bytes whole{0};
  const std::string text = files::read_regular(file().path, 1 << 20).text;
  whole.insert(whole.end(), text.begin(), text.end());
  return {records, whole};
}

}  // namespace rtg::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::span bytes(data + 1, size - 1);
  if (data[0] & 1)
    rtg::fuzz::check_records(bytes);
  else
    rtg::fuzz::check_file(bytes);
  return 0;
}

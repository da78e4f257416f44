#include "nodes/journal/journal.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <string>

#include "nodes/files/regular_file.hpp"
#include "tests/support/folder.hpp"

namespace rtg::journal {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::int64_t kIdentity = 0x0123456789abcdef;
const std::vector<std::pair<std::int64_t, Bytes>> kRecords{
    {7, {1, 2, 3, 4, 5}}, {-1, {}}, {9, {0, 255, 0}}};

struct JournalTest : ::testing::Test {
  const testing::Folder folder;
  const std::filesystem::path path = folder.path / "journal";

  std::string text() const { return files::read_regular(path, 1 << 20).text; }
  void set_text(const std::string& text) const { std::ofstream(path, std::ios::binary) << text; }

  /// Fills the file with kRecords. Returns the ends of its head and of each record.
  std::vector<std::size_t> fill() const {
    Journal journal(path, kIdentity);
    std::vector<std::size_t> ends{text().size()};
    for (const auto& [id, bytes] : kRecords) {
      journal.append(id, bytes);
      ends.push_back(text().size());
    }
    return ends;
  }
};

std::string refusal(const std::filesystem::path& path) {
  try {
    Journal(path, kIdentity);
  } catch (const JournalError& error) {
    return error.what();
  }
  return "";
}

TEST_F(JournalTest, HasItsRecordsWhenItIsOpenedAgain) {
  fill();
  const Journal journal(path, kIdentity);
  for (const auto& [id, bytes] : kRecords) EXPECT_EQ(journal.find(id), bytes);
  EXPECT_FALSE(journal.find(8).has_value());
  EXPECT_EQ(journal.size(), kRecords.size());
}

TEST_F(JournalTest, ALaterRecordReplacesAnEarlierOne) {
  fill();
  Journal(path, kIdentity).append(7, Bytes{8});
  EXPECT_EQ(Journal(path, kIdentity).find(7), Bytes{8});
  EXPECT_EQ(Journal(path, kIdentity).size(), kRecords.size());
}

TEST_F(JournalTest, TornAtAnyByteKeepsTheRecordsBeforeAndGrowsOn) {
  const std::vector<std::size_t> ends = fill();
  const std::string whole = text();
  for (std::size_t cut = 0; cut < whole.size(); ++cut) {
    set_text(whole.substr(0, cut));
    {
      Journal torn(path, kIdentity);
      const auto kept = std::ranges::upper_bound(ends, cut) - ends.begin();
      const std::size_t end = kept > 0 ? ends[static_cast<std::size_t>(kept - 1)] : 0;
      EXPECT_EQ(torn.dropped_bytes(), static_cast<std::int64_t>(cut - end)) << cut;
      torn.append(10, Bytes{6, 6});
    }
    const Journal journal(path, kIdentity);
    for (std::size_t k = 0; k < kRecords.size(); ++k) {
      const auto& [id, bytes] = kRecords[k];
      EXPECT_EQ(journal.find(id), cut >= ends[k + 1] ? std::optional(bytes) : std::nullopt) << cut;
    }
    EXPECT_EQ(journal.find(10), (Bytes{6, 6})) << cut;
  }
}

TEST_F(JournalTest, AFlippedBitAnywhereCostsTheRecordsFromThereOn) {
  const std::vector<std::size_t> ends = fill();
  const std::string whole = text();
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    std::string damaged = whole;
    damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << bit % 8));
    set_text(damaged);
    const Journal journal(path, kIdentity);
    for (std::size_t k = 0; k < kRecords.size(); ++k) {
      const auto& [id, bytes] = kRecords[k];
      const bool before = bit / 8 >= ends[k + 1];
      EXPECT_EQ(journal.find(id), before ? std::optional(bytes) : std::nullopt) << bit;
    }
  }
}

TEST_F(JournalTest, ARecordThatIsDamagedWhileItIsOpenIsNotFound) {
  fill();
  const Journal journal(path, kIdentity);
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(-5, std::ios::end);
  file << 'x';
  file.close();
  EXPECT_FALSE(journal.find(9).has_value());
  EXPECT_EQ(journal.find(7), kRecords[0].second);
}

TEST_F(JournalTest, OfAnotherIdentityBeginsAnew) {
  const std::size_t head = fill()[0];
  const auto size = static_cast<std::int64_t>(text().size());
  EXPECT_EQ(Journal(path, kIdentity + 1).dropped_bytes(), size);
  EXPECT_EQ(Journal(path, kIdentity + 1).size(), 0U);
  EXPECT_EQ(text().size(), head);
  EXPECT_EQ(Journal(path, kIdentity).size(), 0U) << "the records are gone";
}

TEST_F(JournalTest, ARecordOfAnotherIdentityIsNoRecord) {
  const std::size_t head = fill()[0];
  const std::string records = text().substr(head);
  const Journal another(path, kIdentity + 1);
  const std::string head_of_another = text();
  set_text(head_of_another + records);  // as a file system could leave it after a power cut
  const std::filesystem::path copy = folder.path / "copy";
  std::filesystem::copy_file(path, copy);
  EXPECT_EQ(Journal(copy, kIdentity + 1).size(), 0U);
}

TEST_F(JournalTest, WhatIsNoFileOrOpenElsewhereIsRefusedByName) {
  EXPECT_EQ(refusal(folder.path), folder.path.string() + ": cannot be opened: Is a directory");
  const std::filesystem::path fifo = folder.path / "fifo", link = folder.path / "link";
  mkfifo(fifo.c_str(), 0600);
  EXPECT_EQ(refusal(fifo), fifo.string() + ": is no regular file");
  std::filesystem::create_symlink(path, link);
  EXPECT_NE(refusal(link), "");
  const Journal open(path, kIdentity);
  EXPECT_EQ(refusal(path), path.string() + ": another process has it open");
}

TEST_F(JournalTest, WhereTheDiskIsFullItSaysSoAndKeepsWhatItHas) {
  fill();
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  std::string words;
  {
    Journal journal(path, kIdentity);
    rlimit limit = before;
    limit.rlim_cur = text().size() + 20;  // a part of the record fits
    setrlimit(RLIMIT_FSIZE, &limit);
    try {
      journal.append(10, Bytes(100));
    } catch (const JournalError& error) {
      words = error.what();
    }
    setrlimit(RLIMIT_FSIZE, &before);
    EXPECT_FALSE(journal.find(10).has_value());
  }
  EXPECT_EQ(words, path.string() + ": cannot be written: File too large");
  Journal journal(path, kIdentity);
  EXPECT_EQ(journal.size(), kRecords.size());
  journal.append(10, Bytes{1});
  EXPECT_EQ(Bytes{1}, journal.find(10));
}

TEST_F(JournalTest, RecordsThatNoReaderWouldTakeAreNotWritten) {
  Journal journal(path, kIdentity);
  journal.append(1, Bytes(Journal::kMaxBytes));
  EXPECT_THROW(journal.append(2, Bytes(Journal::kMaxBytes + 1)), std::length_error);
  EXPECT_EQ(journal.size(), 1U);
}

}  // namespace
}  // namespace rtg::journal

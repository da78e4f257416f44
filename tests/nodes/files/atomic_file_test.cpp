#include "nodes/files/atomic_file.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <system_error>

#include "tests/support/folder.hpp"

namespace rtg::files {
namespace {

std::string content(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(WriteAtomically, ReplacesTheFileAndWhatAKilledWriterLeft) {
  const testing::Folder folder;
  const std::filesystem::path path = folder.path / "file";
  std::ofstream(folder.path / "file.part") << "left by a killed writer";
  write_atomically(path, "a long first text");
  EXPECT_EQ(content(path), "a long first text");
  write_atomically(path, "second");
  EXPECT_EQ(content(path), "second");
  EXPECT_FALSE(std::filesystem::exists(folder.path / "file.part"));
}

TEST(WriteAtomically, GivesANewFileItsMode) {
  const testing::Folder folder;
  write_atomically(folder.path / "file", "secret", 0600);
  EXPECT_EQ(std::filesystem::status(folder.path / "file").permissions(),
            std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
}

TEST(WriteAtomically, NamesTheFileThatItCannotWrite) {
  const testing::Folder folder;
  const std::filesystem::path path = folder.path / "none" / "file";
  try {
    write_atomically(path, "text");
    FAIL();
  } catch (const std::system_error& error) {
    EXPECT_NE(std::string(error.what()).find(path.string()), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace rtg::files

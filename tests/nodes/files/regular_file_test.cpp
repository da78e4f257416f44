#include "nodes/files/regular_file.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "tests/support/folder.hpp"

namespace rtg::files {
namespace {

TEST(ReadRegular, ReadsTheWholeFile) {
  const testing::Folder folder;
  const std::string text("with a NUL\0 in it\n", 18);
  std::ofstream(folder.path / "file", std::ios::binary) << text;
  EXPECT_EQ(read_regular(folder.path / "file", 18).text, text);
  EXPECT_EQ(read_regular(folder.path / "file", 18).defect, "");
}

TEST(ReadRegular, SaysWhyAFileCannotBeRead) {
  const testing::Folder folder;
  std::ofstream(folder.path / "long") << std::string(20, 'a');
  mkfifo((folder.path / "fifo").c_str(), 0600);
  const auto defect = [&](const std::string& name) {
    return read_regular(folder.path / name, 19).defect;
  };
  EXPECT_EQ(defect("none"), "no such file");
  EXPECT_EQ(defect("."), "is a folder");
  EXPECT_EQ(defect("long"), "is longer than 19 bytes");
  EXPECT_EQ(defect("long/file"), "cannot be read: Not a directory");
  EXPECT_EQ(defect("fifo"), "is no regular file");       // opening it would wait for a writer
  EXPECT_EQ(defect("/dev/zero"), "is no regular file");  // reading it would never end
}

TEST(ReadRegular, AFileThatOthersCanReadIsNoSecret) {
  const testing::Folder folder;
  const std::filesystem::path file = folder.path / "file";
  std::ofstream(file) << "secret";
  for (const mode_t mode : {0600, 0640, 0604, 0620}) {
    chmod(file.c_str(), mode);
    EXPECT_EQ(read_regular(file, 10, Readers::kOwnerAlone).defect.empty(), mode == 0600) << mode;
    EXPECT_EQ(read_regular(file, 10).text, "secret");
  }
}

}  // namespace
}  // namespace rtg::files

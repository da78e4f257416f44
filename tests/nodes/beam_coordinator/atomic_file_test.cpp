#include "nodes/beam_coordinator/atomic_file.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <system_error>

namespace rtg::beam_coordinator {
namespace {

std::string content(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// An empty folder of the running test's own, as tests run side by side; it is removed in the end.
struct Folder {
  std::filesystem::path path =
      std::filesystem::path(::testing::TempDir()) /
      (std::string("atomic_file_test.") + ::testing::UnitTest::GetInstance()->current_test_info()->name());

  Folder() { std::filesystem::create_directory(path); }
  ~Folder() { std::filesystem::remove_all(path); }
};

TEST(WriteAtomically, ReplacesTheFileAndWhatAKilledWriterLeft) {
  const Folder folder;
  const std::filesystem::path path = folder.path / "file";
  std::ofstream(folder.path / "file.part") << "left by a killed writer";
  write_atomically(path, "a long first text");
  EXPECT_EQ(content(path), "a long first text");
  write_atomically(path, "second");
  EXPECT_EQ(content(path), "second");
  EXPECT_FALSE(std::filesystem::exists(folder.path / "file.part"));
}

TEST(WriteAtomically, NamesTheFileThatItCannotWrite) {
  const Folder folder;
  const std::filesystem::path path = folder.path / "none" / "file";
  try {
    write_atomically(path, "text");
    FAIL();
  } catch (const std::system_error& error) {
    EXPECT_NE(std::string(error.what()).find(path.string()), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace rtg::beam_coordinator
